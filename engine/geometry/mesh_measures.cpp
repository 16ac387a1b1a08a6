#include "engine/geometry/mesh_measures.hpp"

#include <algorithm>
#include <limits>
#include <optional>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "engine/geometry/for_each_triangle.hpp"

namespace fascicle {
float Bounds::diagonal() const {
  constexpr double kLargest = std::numeric_limits<float>::max();
  return static_cast<float>(std::min(glm::distance(glm::dvec3(lower), glm::dvec3(upper)), kLargest));
}

Bounds mesh_bounds(const TriangleMesh& mesh) {
  constexpr double kMost = std::numeric_limits<double>::max();
  glm::dvec3 lower(kMost), upper(-kMost);
  for_each_triangle(mesh, [&](const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
    lower = glm::min(lower, glm::min(a, glm::min(b, c)));
    upper = glm::max(upper, glm::max(a, glm::max(b, c)));
  });
  if (lower.x > upper.x) return {};
  return {glm::vec3(lower), glm::vec3(upper)};
}

double mesh_area(const TriangleMesh& mesh) {
  double area = 0.0;
  for_each_triangle(mesh, [&](const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
    area += 0.5 * glm::length(glm::cross(b - a, c - a));
  });
  return area;
}

double mesh_volume(const TriangleMesh& mesh) {
  // Measured from the first triangle, so that a mesh far from the origin loses no digits.
  std::optional<glm::dvec3> first;
  double volume = 0.0;
  for_each_triangle(mesh, [&](const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
    if (!first) first = a;
    const glm::dvec3 from = *first;
    volume += glm::dot(a - from, glm::cross(b - from, c - from)) / 6.0;
  });
  return volume;
}

}  // namespace fascicle
