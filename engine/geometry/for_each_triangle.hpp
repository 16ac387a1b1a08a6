// The loop over a mesh's triangles that every sum over its surface starts with.
#pragma once

#include <glm/vec3.hpp>

#include "engine/content/triangle_mesh.hpp"
#include "engine/geometry/finite.hpp"

namespace fascicle {

// f(a, b, c) for the corners of each triangle, in order, but not where one is not finite. Indices must be in range.
template <class F>
void for_each_triangle(const TriangleMesh& mesh, F f) {
  for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
    const glm::vec3& a = mesh.positions[mesh.indices[i]];
    const glm::vec3& b = mesh.positions[mesh.indices[i + 1]];
    const glm::vec3& c = mesh.positions[mesh.indices[i + 2]];
    if (is_finite(a) && is_finite(b) && is_finite(c)) f(glm::dvec3(a), glm::dvec3(b), glm::dvec3(c));
  }
}

}  // namespace fascicle
