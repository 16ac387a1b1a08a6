// From descriptions (what a content file or a program says) to the immutable MuscleAsset: checks everything, subdivides
// the action lines, binds their points to bones, finds rest frames, tendons and radii, and lays the data out.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

#include "engine/content/result.hpp"
#include "modules/muscle/asset/muscle_asset.hpp"

namespace fascicle::muscle {

// What a fit to an anatomical mesh found for one muscle (the method's page 2). Empty members: nothing to change.
struct MuscleFit {
  std::vector<glm::vec3> displacements;  // m, mu per section, in the rest bones' space
  std::vector<float> radii;              // m, |C| per section; may be negative
  // The first and the last section's normal where an attachment area gives it, by MuscleEnd: unit, in the rest bones'
  // space, along the line from origin to insertion.
  std::array<std::optional<glm::vec3>, 2> end_normals;
};

// Builds the asset. `rest_bones` are the skeleton's bone-to-character matrices at rest; the attachments' positions are
// in their bones' frames. `fits` is empty or holds one entry per description.
//
// At rest every stored point comes back bit for bit (rest_x/y/z are made by the kernel that places points), and an
// attachment agrees with rest_bones[bone] * position to rounding.
//
// Errors, all of them in one go, each placed by the description's `where` (its path extended by the field): no or
// doubled name, fewer than two attachments, bone out of range, two neighbouring attachments at one place, |C| odd, < 6
// or > 256, LSS > 6, a number that is not finite, negative or out of range parameters, no source for the radii, PCSA
// without a fibre length, profile fractions that do not rise within 0..1, tendon fractions that sum to more than 1,
// bone matrices that are not finite or singular, a fit of the wrong size.
Result<std::shared_ptr<const MuscleAsset>> build_muscle_asset(std::span<const MuscleDescription> descriptions,
                                                              std::span<const glm::mat4> rest_bones,
                                                              std::span<const MuscleFit> fits = {});

}  // namespace fascicle::muscle
