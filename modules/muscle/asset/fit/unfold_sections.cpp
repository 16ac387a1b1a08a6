#include "modules/muscle/asset/fit/unfold_sections.hpp"

#include <algorithm>
#include <cstddef>

#include <glm/geometric.hpp>

namespace fascicle::muscle {
namespace {

// `side`: 1 for a neighbour after, -1 for one before, whose planes a section must not pass forward and backward.
double shorten(double radius, const glm::dvec3& centre, const glm::dvec3& direction, const SectionFrame& neighbour,
               double side) {
  const double towards = side * glm::dot(direction, neighbour.tangent);
  const double away = side * glm::dot(neighbour.centre - centre, neighbour.tangent);
  if (towards <= 0.0 || away <= 0.0) return radius;
  return std::min(radius, away / towards);
}

}  // namespace

void unfold_sections(std::span<const SectionFrame> frames, std::span<const glm::dvec2> directions,
                     std::span<double> radii) {
  const std::size_t count = directions.size();
  for (std::size_t k = 0; k < frames.size(); ++k) {
    const SectionFrame& frame = frames[k];
    for (std::size_t i = 0; i < count; ++i) {
      double& radius = radii[k * count + i];
      if (radius <= 0.0) continue;
      const glm::dvec3 direction = directions[i].x * frame.u + directions[i].y * frame.v;
      if (k > 0) radius = shorten(radius, frame.centre, direction, frames[k - 1], -1.0);
      if (k + 1 < frames.size()) radius = shorten(radius, frame.centre, direction, frames[k + 1], 1.0);
    }
  }
}

}  // namespace fascicle::muscle
