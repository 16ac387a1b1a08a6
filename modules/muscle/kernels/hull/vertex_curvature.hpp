// The full mesh's Laplacian coordinates, by one piece of code for rest and pose: a mesh at rest is exactly so.
#pragma once

#include <cstdint>
#include <span>

#include <glm/vec3.hpp>

#include "modules/muscle/asset/hull/hull_asset.hpp"

namespace fascicle::muscle {

// 1/m: d_i = (L V)_i / m_i. `inverse_mass`: 1 / m_i (1/m^2).
inline glm::vec3 vertex_curvature(const HullFullMesh& full, std::span<const SurfacePoint> points, std::uint32_t v,
                                  float inverse_mass) {
  glm::vec3 sum(0.0f);
  for (std::uint32_t i = full.first[v]; i < full.first[v + 1]; ++i) {
    const SurfacePoint &p = points[v], &q = points[full.neighbour[i]];
    sum += full.weight[i] * glm::vec3(p.x - q.x, p.y - q.y, p.z - q.z);
  }
  return inverse_mass * sum;
}

}  // namespace fascicle::muscle
