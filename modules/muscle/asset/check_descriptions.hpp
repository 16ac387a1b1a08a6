// The checks that `build_muscle_asset` makes before it builds: everything that could make a number that is not finite,
// an index out of range or a muscle without a shape, each with its place, cause and remedy.
#pragma once

#include <span>
#include <string>

#include <glm/mat4x4.hpp>

#include "engine/content/result.hpp"
#include "modules/muscle/asset/build_muscle_asset.hpp"

namespace fascicle::muscle {

inline constexpr std::uint32_t kMostSubdivisions = 6;

// A fault of one description, at `field` inside of it.
Diagnostic fault_of(const MuscleDescription& description, const std::string& field, std::string cause,
                    std::string remedy);

Diagnostics check_descriptions(std::span<const MuscleDescription> descriptions, std::span<const glm::mat4> rest_bones,
                               std::span<const MuscleFit> fits);

}  // namespace fascicle::muscle
