#include "modules/muscle/content/surface_line.hpp"

#include <algorithm>
#include <limits>

#include <fmt/format.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "engine/geometry/mesh_measures.hpp"
#include "modules/muscle/content/surface_limits.hpp"

namespace fascicle::muscle {

namespace {

// A line leaves the muscle's box where a tendon does, but not all of it is further away than this part of its diagonal.
constexpr float kReach = 0.25f;

float distance_from(const Bounds& box, const glm::vec3& p) {
  return glm::distance(p, glm::clamp(p, box.lower, box.upper));
}

// Of the nearest point between `a` and `b`: long tendons begin and end far from a belly that they lead through. Along a
// straight line the distance from a box falls, then rises.
float distance_from(const Bounds& box, const glm::vec3& a, const glm::vec3& b) {
  float low = 0.0f, high = 1.0f;
  for (int i = 0; i < 50; ++i) {
    const float one = low + (high - low) / 3.0f, other = high - (high - low) / 3.0f;
    if (distance_from(box, glm::mix(a, b, one)) > distance_from(box, glm::mix(a, b, other))) {
      low = one;
    } else {
      high = other;
    }
  }
  return distance_from(box, glm::mix(a, b, 0.5f * (low + high)));
}

}  // namespace

void place_action_line(const SurfaceMuscleEntry& entry, const SurfaceMesh& mesh, SurfaceMuscleDescription& muscle,
                       Diagnostics& diagnostics) {
  if (entry.action_line.empty()) return;
  const Bounds box = mesh_bounds(mesh.rest);
  float nearest = std::numeric_limits<float>::infinity();
  double length = 0.0;
  for (std::size_t i = 0; i < entry.action_line.size(); ++i) {
    const LinePointEntry& point = entry.action_line[i];
    if (!point.position) return;  // told where it was read
    glm::vec3& position = muscle.action_line[i].position;
    position = point.in_rest_space ? *point.position : glm::vec3(mesh.placement * glm::vec4(*point.position, 1.0f));
    if (i == 0) continue;
    const glm::vec3& before = muscle.action_line[i - 1].position;
    nearest = std::min(nearest, distance_from(box, before, position));
    length += glm::distance(glm::dvec3(position), glm::dvec3(before));
  }
  if (nearest > kReach * box.diagonal()) {
    entry.action_line_node.error(
        diagnostics, fmt::format("the line is {:.4g} mm away from the muscle", 1000.0f * nearest),
        "a point's \"at\" is in the mesh file's own coordinates and unit, or with \"space\": \"character\" in metres "
        "in the character's rest space");
  } else if (length < static_cast<double>(kShortestLine)) {
    entry.action_line_node.error(diagnostics,
                                 fmt::format("the line is {:.3g} mm long, and has no direction", 1000.0 * length),
                                 "lead it from the middle of the origin to that of the insertion");
  }
}

}  // namespace fascicle::muscle
