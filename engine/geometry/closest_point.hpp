// The nearest point of a mesh's surface. A tree is built once; questions are thread-safe.
#pragma once

#include <cstdint>
#include <limits>
#include <memory>

#include <glm/vec3.hpp>

#include "engine/content/triangle_mesh.hpp"

namespace fascicle {

struct ClosestPoint {
  glm::vec3 position{0.0f};                                      // m
  float distance = std::numeric_limits<float>::max();            // m
  std::uint32_t triangle = std::numeric_limits<std::uint32_t>::max();
};

class ClosestPoints {
 public:
  // Keeps its own copy of the triangles; those with a corner that is not finite do not count.
  explicit ClosestPoints(const TriangleMesh& mesh);
  ~ClosestPoints();
  ClosestPoints(ClosestPoints&&) noexcept;
  ClosestPoints& operator=(ClosestPoints&&) noexcept;

  bool empty() const;  // no triangle counts

  // Exact but for rounding. For a mesh without triangles, or a point that is not finite, a default ClosestPoint.
  ClosestPoint at(const glm::vec3& point) const;
  // The same where the nearest point is nearer than `limit` (m), and a default ClosestPoint where it is not; the quicker
  // the less the limit is.
  ClosestPoint within(const glm::vec3& point, float limit) const;

 private:
  struct State;
  std::unique_ptr<const State> state_;
};

// The point of one triangle that is nearest to `point`; of a degenerate one too.
glm::dvec3 closest_point_on_triangle(const glm::dvec3& point, const glm::dvec3& a, const glm::dvec3& b,
                                     const glm::dvec3& c);

}  // namespace fascicle
