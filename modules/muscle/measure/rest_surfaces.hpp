// A musculature as it stands in the rest pose, carried by its bones and touched by nothing: what penetration is
// compared with.
#pragma once

#include <memory>
#include <span>

#include <glm/mat4x4.hpp>

#include "modules/muscle/asset/muscle_asset.hpp"
#include "modules/muscle/components/muscle_surfaces.hpp"
#include "modules/muscle/components/tendons.hpp"

namespace fascicle::muscle {

struct RestSurfaces {
  MuscleSurfaces surfaces;
  Tendons tendons;
};

// `bones`: bone to world at rest, as many as the asset asks for.
RestSurfaces make_rest_surfaces(std::shared_ptr<const MuscleAsset> asset, std::span<const glm::mat4> bones);

}  // namespace fascicle::muscle
