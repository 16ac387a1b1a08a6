#include "modules/muscle/asset/fit/inner_point.hpp"

#include <array>
#include <cmath>

namespace fascicle::muscle {
namespace {

double cross(const glm::dvec2& a, const glm::dvec2& b) { return a.x * b.y - a.y * b.x; }

// Of the polygon a b c d, which may cross itself; of one without area, the vertices' mean.
glm::dvec2 area_centroid(const std::array<glm::dvec2, 4>& corners) {
  const glm::dvec2 mean = 0.25 * (corners[0] + corners[1] + corners[2] + corners[3]);
  double area = 0.0, extent = 0.0;
  glm::dvec2 sum(0.0);
  for (std::size_t i = 0; i < 4; ++i) {
    const glm::dvec2 a = corners[i] - mean, b = corners[(i + 1) % 4] - mean;
    const double part = cross(a, b);
    area += part;
    extent += a.x * a.x + a.y * a.y;
    sum += part * (a + b);
  }
  return std::abs(area) > 1.0e-9 * extent ? mean + sum / (3.0 * area) : mean;
}

}  // namespace

glm::dvec2 inner_point(std::span<const std::uint32_t> ordered, std::span<const double> radii,
                       std::span<const glm::dvec2> directions) {
  if (ordered.empty()) return glm::dvec2(0.0);
  const std::size_t half = radii.size() / 2, middle = ordered.size() / 2;
  const auto surface_points = [&](std::size_t match) {
    const std::size_t i = ordered[match], opposite = (i + half) % radii.size();
    return std::array<glm::dvec2, 2>{radii[i] * directions[i], radii[opposite] * directions[opposite]};
  };
  const std::array<glm::dvec2, 2> after = surface_points(middle);
  if (ordered.size() % 2 == 1) return 0.5 * (after[0] + after[1]);
  const std::array<glm::dvec2, 2> before = surface_points(middle - 1);
  return area_centroid({before[0], after[0], after[1], before[1]});
}

}  // namespace fascicle::muscle
