// The points of the two muscles of a pair, both in the first one's frame.
#pragma once

#include <cstdint>

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

#include "modules/muscle/kernels/surface/surface_pairs.hpp"

namespace fascicle::muscle {

inline bool is_identity(const glm::mat4& m) { return m == glm::mat4(1.0f); }

class PairedPoints {
 public:
  PairedPoints(const PairedSurface& surface, const glm::mat4& to_first)
      : points_(surface.points), triangles_(surface.asset->triangles), axes_(to_first), origin_(to_first[3]),
        same_(is_identity(to_first)) {}

  glm::vec3 at(std::uint32_t v) const {
    const glm::vec3 p(points_[v].x, points_[v].y, points_[v].z);
    return same_ ? p : axes_ * p + origin_;
  }
  float inverse_mass(std::uint32_t v) const { return points_[v].inverse_mass; }
  const std::uint32_t* corners(std::uint32_t triangle) const { return &triangles_[3 * std::size_t{triangle}]; }

  // `by` in the first one's frame.
  void move(std::uint32_t v, const glm::vec3& by) const {
    const glm::vec3 own = same_ ? by : by * axes_;  // the inverse of a rotation is its transpose
    points_[v].x += own.x;
    points_[v].y += own.y;
    points_[v].z += own.z;
  }

 private:
  std::span<SurfacePoint> points_;
  std::span<const std::uint32_t> triangles_;
  glm::mat3 axes_;
  glm::vec3 origin_;
  bool same_;
};

}  // namespace fascicle::muscle
