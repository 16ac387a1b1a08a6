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

// For each input the level with the fewest vertices, of |C| = 6..36 and LSS = 0..5, that keeps its bound (m); the |C| and
// LSS of the descriptions are not read. Distances are those of compare_fit: from the fitted surface to the mesh and
// back, where heads of one mesh answer for the part of it that is theirs. Where no level keeps the bound (a mesh that
// reaches beyond the attachments, say): the level with the fewest vertices that comes within 5 % of the best. Inputs without a mesh, or that cannot be
// fitted, keep their description's level and count as kept.
std::vector<ChosenLevel> choose_levels(std::span<const FitInput> inputs, std::span<const float> max_distances,
                                       std::span<const glm::mat4> rest_bones, const FitOptions& options = {});

}  // namespace fascicle::muscle
