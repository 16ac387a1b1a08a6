#include "modules/muscle/kernels/hull/mesh_volume.hpp"

#include <algorithm>

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

namespace fascicle::muscle {

double measure_volume(std::span<const std::uint32_t> triangles, std::span<const SurfacePoint> points,
                      std::span<SurfacePoint> gradient) {
  std::ranges::fill(gradient, SurfacePoint{});
  if (points.empty()) return 0.0;
  const glm::vec3 origin(points[0].x, points[0].y, points[0].z);
  const auto place = [&](std::uint32_t v) { return glm::vec3(points[v].x, points[v].y, points[v].z) - origin; };
  const auto add = [&](std::uint32_t v, const glm::vec3& sixth) {
    gradient[v].x += sixth.x;
    gradient[v].y += sixth.y;
    gradient[v].z += sixth.z;
  };
  double six_volumes = 0.0;
  for (std::size_t t = 0; t + 2 < triangles.size(); t += 3) {
    const std::uint32_t a = triangles[t], b = triangles[t + 1], c = triangles[t + 2];
    const glm::vec3 p = place(a), q = place(b), r = place(c), across = glm::cross(q, r);
    six_volumes += static_cast<double>(glm::dot(p, across));
    if (gradient.empty()) continue;
    constexpr float kSixth = 1.0f / 6.0f;
    add(a, kSixth * across);
    add(b, kSixth * glm::cross(r, p));
    add(c, kSixth * glm::cross(p, q));
  }
  return six_volumes / 6.0;
}

}  // namespace fascicle::muscle
