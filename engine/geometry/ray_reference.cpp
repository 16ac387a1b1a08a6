#include "engine/geometry/ray_reference.hpp"

#include <cmath>

#include <glm/geometric.hpp>

namespace fascicle {
namespace {

// f(t, triangle, exit) for each triangle that the line crosses.
template <class F>
void for_each_crossing(const TriangleMesh& mesh, const Line& line, F f) {
  for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
    const glm::vec3& a = mesh.positions[mesh.indices[i]];
    const glm::vec3 ab = mesh.positions[mesh.indices[i + 1]] - a, ac = mesh.positions[mesh.indices[i + 2]] - a;
    const glm::vec3 p = glm::cross(line.direction, ac);
    const float determinant = glm::dot(ab, p);
    if (determinant == 0.0f) continue;
    const float inverse = 1.0f / determinant;
    const glm::vec3 s = line.origin - a;
    const float u = inverse * glm::dot(s, p);
    if (u < 0.0f || u > 1.0f) continue;
    const glm::vec3 q = glm::cross(s, ab);
    const float v = inverse * glm::dot(line.direction, q);
    if (v < 0.0f || u + v > 1.0f) continue;
    // The determinant is minus the direction's share in the normal ab x ac.
    f(inverse * glm::dot(ac, q), static_cast<std::uint32_t>(i / 3), determinant < 0.0f);
  }
}

}  // namespace

void cast_lines_reference(const TriangleMesh& mesh, std::span<const Line> lines, std::span<LineExtremes> extremes) {
  for (std::size_t i = 0; i < lines.size(); ++i) {
    LineExtremes found;
    float first_exit = found.first_entry, last_entry = found.last_exit;
    for_each_crossing(mesh, lines[i], [&](float t, std::uint32_t, bool exit) {
      if (exit) {
        found.last_exit = std::max(found.last_exit, t);
        first_exit = std::min(first_exit, t);
      } else {
        found.first_entry = std::min(found.first_entry, t);
        last_entry = std::max(last_entry, t);
      }
      ++found.crossings;
    });
    found.backwards = first_exit < found.first_entry || last_entry > found.last_exit;
    extremes[i] = found;
  }
}

void cross_line_reference(const TriangleMesh& mesh, const Line& line, std::vector<LineCrossing>& crossings) {
  for_each_crossing(mesh, line, [&](float t, std::uint32_t triangle, bool exit) {
    crossings.push_back({t, triangle, exit});
  });
}

}  // namespace fascicle
