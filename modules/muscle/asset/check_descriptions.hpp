// The checks that `build_muscle_asset` makes before it builds: everything that could make a number that is not finite,
// an index out of range or a muscle without a shape, each with its place, cause and remedy.
#pragma once

#include <optional>
#include <span>
#include <string>

#include <glm/mat4x4.hpp>

#include "engine/content/result.hpp"
#include "modules/muscle/asset/build_muscle_asset.hpp"

namespace fascicle::muscle {

// A fault of one description, at `field` inside of it.
Diagnostic fault_of(const MuscleDescription& description, const std::string& field, std::string cause,
                    std::string remedy);

// What a muscle lacks to be given a thickness, the volume of its belly or radii in metres; nothing where it has enough.
struct MissingThickness {
  std::string cause;
  std::string remedy;
};
std::optional<MissingThickness> find_missing_thickness(const MuscleDescription& description);

// The parts of check_descriptions, for a loader that has other errors to report along with these: bones that are not
// finite or singular; and one description by itself, on bones that are sound.
Diagnostics check_rest_bones(std::span<const glm::mat4> rest_bones);
Diagnostics check_description(const MuscleDescription& description, std::span<const glm::mat4> rest_bones,
                              const MuscleFit* fit = nullptr);

// Everything, and that no name occurs twice.
Diagnostics check_descriptions(std::span<const MuscleDescription> descriptions, std::span<const glm::mat4> rest_bones,
                               std::span<const MuscleFit> fits);

}  // namespace fascicle::muscle
