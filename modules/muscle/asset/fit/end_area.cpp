#include "modules/muscle/asset/fit/end_area.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include <glm/geometric.hpp>

#include "engine/geometry/principal_axes.hpp"

namespace fascicle::muscle {
namespace {

constexpr double kLeastCosine = 0.5;  // of 60 degrees
constexpr double kFlattest = 1.0e-3;  // an area's second deviation over its first: below it is a line

}  // namespace

TriangleMesh take_triangles(const TriangleMesh& mesh, std::span<const std::uint32_t> triangles) {
  TriangleMesh area;
  area.positions = mesh.positions;
  for (const std::uint32_t triangle : triangles) {
    for (std::size_t i = 0; i < 3; ++i) area.indices.push_back(mesh.indices[3 * std::size_t{triangle} + i]);
  }
  return area;
}

std::optional<glm::dvec3> area_normal(const TriangleMesh& area, const glm::dvec3& along) {
  const PrincipalAxes axes = principal_axes(area);
  if (!(axes.deviations[1] > kFlattest * axes.deviations[0])) return std::nullopt;
  glm::dvec3 normal = axes.axes[2];
  if (glm::dot(normal, along) < 0.0) normal = -normal;
  const double cosine = glm::dot(normal, along);
  if (cosine >= kLeastCosine) return normal;
  const glm::dvec3 sideways = normal - cosine * along;  // not zero: the normal is far from the line
  return kLeastCosine * along + std::sqrt(1.0 - kLeastCosine * kLeastCosine) * glm::normalize(sideways);
}

void cast_area(const TriangleMesh& area, const SectionFrame& frame, std::size_t section,
               std::span<const glm::dvec2> directions, SectionRays& rays) {
  std::vector<glm::dvec2> corners;
  for (const std::uint32_t index : area.indices) {
    const glm::dvec3 off = glm::dvec3(area.positions[index]) - frame.centre;
    corners.emplace_back(glm::dot(off, frame.u), glm::dot(off, frame.v));
  }
  const std::size_t half = rays.count / 2;
  for (std::size_t i = 0; i < half; ++i) {
    const glm::dvec2 e = directions[i];
    double first = std::numeric_limits<double>::infinity(), last = -first;
    for (std::size_t c = 0; c < corners.size(); ++c) {
      const glm::dvec2 &a = corners[c], &b = corners[c % 3 == 2 ? c - 2 : c + 1];
      const double side_a = e.x * a.y - e.y * a.x, side_b = e.x * b.y - e.y * b.x;
      if ((side_a < 0.0) == (side_b < 0.0)) continue;
      const double t = glm::dot(e, a + side_a / (side_a - side_b) * (b - a));
      first = std::min(first, t);
      last = std::max(last, t);
    }
    const bool hit = first <= last;
    const std::size_t ray = section * rays.count + i;
    rays.hits[ray] = rays.hits[ray + half] = hit ? 1 : 0;
    rays.radii[ray] = hit ? last : 0.0;
    rays.radii[ray + half] = hit ? -first : 0.0;
  }
}

}  // namespace fascicle::muscle
