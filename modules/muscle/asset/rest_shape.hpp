// Last step of building an asset: the frames' end directions, and radii whose bellies have the volumes asked for.
#pragma once

#include <span>

#include <glm/mat4x4.hpp>

#include "modules/muscle/asset/build_muscle_asset.hpp"

namespace fascicle::muscle {

// Sets asset.ends so that at rest no muscle is twisted, asset.rest_radii and the muscles' rest_volume. Returns the
// faults of muscles whose belly cannot have the volume asked for.
Diagnostics shape_rest(std::span<const MuscleDescription> descriptions, std::span<const glm::mat4> rest_bones,
                       std::span<const MuscleFit> fits, MuscleAsset& asset);

}  // namespace fascicle::muscle
