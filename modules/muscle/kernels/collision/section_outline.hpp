// How deep a point is in a muscle: its signed distance from the outline that the muscle's surface has in the plane
// through the point, between two cross sections. The outline is the polygon of the points at the same fraction of all
// meridians, so it lies on the drawn surface, and it may have any shape: a wide flat muscle's depth is measured to its
// near side, not along the radius.
#pragma once

#include <cstdint>

#include <glm/vec3.hpp>

namespace fascicle::muscle {

// Two neighbouring sections; arrays of `count` vertices (m, world).
struct OutlineSegment {
  const float* x[2] = {};
  const float* y[2] = {};
  const float* z[2] = {};
  glm::vec3 a[2], u[2], v[2];
  std::uint32_t count = 0;
};

struct OutlinePoint {
  float distance = 0.0f;        // m, negative inside
  glm::vec3 normal{0.0f};       // unit, out of the muscle at the nearest point
  std::uint32_t edge = 0;       // from this vertex to the next
  float fraction = 0.0f;        // along it
};

// The nearest point of the outline at fraction `along` from the first section to the second, for a point in that plane
// whose own surface looks towards `outward` (unit): only edges that face it are asked, so that a point that has come
// through more than half of a thin muscle is still sent back to where it came from; zero asks all edges. False where there is none within
// `reach` (m) outside.
bool find_outline_point(const OutlineSegment& segment, float along, const glm::vec3& point, const glm::vec3& outward,
                        float reach, OutlinePoint& found);

}  // namespace fascicle::muscle
