#include "modules/muscle/kernels/collision/section_outline.hpp"

#include <algorithm>
#include <cmath>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

#include "modules/muscle/kernels/kernel_data.hpp"

namespace fascicle::muscle {
namespace {

constexpr float kFacing = 0.25f;         // an edge whose normal is more along `outward` than this looks the same way
constexpr float kFar = 3.0e38f;          // m^2
constexpr float kShortestEdge = 1.0e-6f;  // m
constexpr float kNearest = 1.0e-5f;      // m: nearer than this an edge's own normal is better than the direction to it

}  // namespace

bool find_outline_point(const OutlineSegment& segment, float along, const glm::vec3& point, const glm::vec3& outward,
                        float reach, OutlinePoint& found) {
  // The plane's axes.
  const glm::vec3 u = glm::normalize(glm::mix(segment.u[0], segment.u[1], along));
  const glm::vec3 lean = glm::mix(segment.v[0], segment.v[1], along);
  const glm::vec3 v = glm::normalize(lean - glm::dot(lean, u) * u);
  float px[kMaxSectionVertices + 1], py[kMaxSectionVertices + 1];  // relative to the point
  const std::uint32_t count = segment.count;
  for (std::uint32_t i = 0; i < count; ++i) {
    const float x = segment.x[0][i] + along * (segment.x[1][i] - segment.x[0][i]) - point.x;
    const float y = segment.y[0][i] + along * (segment.y[1][i] - segment.y[0][i]) - point.y;
    const float z = segment.z[0][i] + along * (segment.z[1][i] - segment.z[0][i]) - point.z;
    px[i] = x * u.x + y * u.y + z * u.z;
    py[i] = x * v.x + y * v.y + z * v.z;
  }
  px[count] = px[0];
  py[count] = py[0];

  // Edge by edge, without a branch, so that the compiler does several at once; an edge that looks the same way as the
  // point's own surface counts as infinitely far.
  const glm::vec2 out(glm::dot(outward, u), glm::dot(outward, v));
  float squares[kMaxSectionVertices], fractions[kMaxSectionVertices];
  int winding = 0;
  for (std::uint32_t i = 0; i < count; ++i) {
    const float ex = px[i + 1] - px[i], ey = py[i + 1] - py[i];
    const float cross = px[i] * ey - py[i] * ex;  // > 0: the point lies on the edge's inner side
    const int up = (py[i] <= 0.0f) & (py[i + 1] > 0.0f) & (cross > 0.0f);
    const int down = (py[i] > 0.0f) & (py[i + 1] <= 0.0f) & (cross < 0.0f);
    winding += up - down;
    const float length2 = std::max(ex * ex + ey * ey, kShortestEdge * kShortestEdge);
    const float facing = std::max(ey * out.x - ex * out.y, 0.0f);  // the edge's normal is (ey, -ex) / length
    const float f = std::min(std::max(-(px[i] * ex + py[i] * ey) / length2, 0.0f), 1.0f);
    const float nx = px[i] + f * ex, ny = py[i] + f * ey;
    fractions[i] = f;
    squares[i] = facing * facing > kFacing * kFacing * length2 ? kFar : nx * nx + ny * ny;
  }
  float best = kFar;
  std::uint32_t edge = count;
  for (std::uint32_t i = 0; i < count; ++i) {
    if (squares[i] < best) {
      best = squares[i];
      edge = i;
    }
  }
  if (edge == count) return false;
  const float fraction = fractions[edge];
  const bool inside = winding > 0;
  const float distance = std::sqrt(best);
  if (!inside && distance > reach) return false;
  const float ex = px[edge + 1] - px[edge], ey = py[edge + 1] - py[edge];
  glm::vec2 normal;
  if (distance > kNearest) {
    const float side = inside ? 1.0f : -1.0f;
    normal = side / distance * glm::vec2(px[edge] + fraction * ex, py[edge] + fraction * ey);
  } else {
    normal = glm::vec2(ey, -ex) / std::max(std::sqrt(ex * ex + ey * ey), kShortestEdge);
  }
  found.distance = inside ? -distance : distance;
  found.normal = normal.x * u + normal.y * v;
  found.edge = edge;
  found.fraction = fraction;
  return true;
}

}  // namespace fascicle::muscle
