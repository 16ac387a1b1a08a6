// Error-bounded level of detail: the least |C| and LSS whose fitted surface stays within a distance of the mesh.
#pragma once

#include <span>
#include <vector>

#include <glm/mat4x4.hpp>

#include "modules/muscle/asset/fit/fit_muscles.hpp"
#include "modules/muscle/asset/muscle_levels.hpp"

namespace fascicle::muscle {

struct ChosenLevel {
  MuscleLevel level;
  float distance = 0.0f;  // m, the largest that it leaves, either way
  bool kept = false;      // false: no level stays within the bound
};

// For each input the level with the fewest vertices, of |C| = 6..36 and LSS = 0..5, that keeps its bound (m); the |C|
// and LSS of the descriptions are not read. It tries about 10 of the 54 levels: at one LSS a greater |C| is taken never
// to be worse, so where it is, by a hair, a level with fewer vertices may be missed. Distances are those of
// compare_fit: from the fitted surface to the mesh and back, where heads of one mesh answer for the part of it that is
// theirs; the levels of several heads depend on each other, so theirs keep their bounds but need not be the fewest.
//
// Where no level keeps the bound (a mesh that reaches beyond the attachments, say): the level with the fewest vertices
// that comes within 5 % of the best. Inputs without a mesh, or that can be fitted or built at no level (four LSS are
// tried), keep their description's level and count as kept: fit_muscles and build_muscle_asset say why.
std::vector<ChosenLevel> choose_levels(std::span<const FitInput> inputs, std::span<const float> max_distances,
                                       std::span<const glm::mat4> rest_bones, const FitOptions& options = {});

}  // namespace fascicle::muscle
