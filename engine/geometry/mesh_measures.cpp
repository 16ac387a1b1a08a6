#include "engine/geometry/mesh_measures.hpp"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace fascicle {
namespace {

// f(a, b, c) for the corners of each triangle.
template <class F>
void for_each_triangle(const TriangleMesh& mesh, F f) {
  for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
    f(mesh.positions[mesh.indices[i]], mesh.positions[mesh.indices[i + 1]], mesh.positions[mesh.indices[i + 2]]);
  }
}

}  // namespace

float Bounds::diagonal() const { return glm::distance(lower, upper); }

Bounds mesh_bounds(const TriangleMesh& mesh) {
  if (mesh.indices.size() < 3) return {};
  Bounds bounds{mesh.positions[mesh.indices[0]], mesh.positions[mesh.indices[0]]};
  for_each_triangle(mesh, [&](const glm::vec3& a, const glm::vec3& b, const glm::vec3& c) {
    bounds.lower = glm::min(bounds.lower, glm::min(a, glm::min(b, c)));
    bounds.upper = glm::max(bounds.upper, glm::max(a, glm::max(b, c)));
  });
  return bounds;
}

double mesh_area(const TriangleMesh& mesh) {
  double area = 0.0;
  for_each_triangle(mesh, [&](const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
    area += 0.5 * glm::length(glm::cross(b - a, c - a));
  });
  return area;
}

double mesh_volume(const TriangleMesh& mesh) {
  if (mesh.indices.size() < 3) return 0.0;
  // Measured from a point of the mesh, so that a mesh far from the origin loses no digits.
  const glm::dvec3 from = mesh.positions[mesh.indices[0]];
  double volume = 0.0;
  for_each_triangle(mesh, [&](const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
    volume += glm::dot(a - from, glm::cross(b - from, c - from)) / 6.0;
  });
  return volume;
}

}  // namespace fascicle
