#include "modules/muscle/asset/fit/outside_section.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace fascicle::muscle {
namespace {

constexpr double kNarrowest = 0.02;  // of the widest radius: a surface needs some width to have normals

const SectionSlice* nearest_within_size(std::span<const SectionSlice> slices) {
  const SectionSlice* nearest = nullptr;
  double least = 0.0;
  for (const SectionSlice& slice : slices) {
    const double distance = slice.distance(glm::dvec2(0.0));
    if (distance > std::sqrt(std::max(slice.area, 0.0)) || (nearest != nullptr && distance >= least)) continue;
    nearest = &slice;
    least = distance;
  }
  return nearest;
}

}  // namespace

void shape_outside_section(std::span<const SectionSlice> slices, std::span<const glm::dvec2> directions,
                           std::span<double> radii, std::span<std::uint8_t> hits) {
  const SectionSlice* slice = nearest_within_size(slices);
  double widest = 0.0;
  std::vector<InsideInterval> inside;
  for (std::size_t i = 0; i < directions.size() && slice != nullptr; ++i) {
    inside.clear();
    find_inside(*slice, directions[i], inside);
    radii[i] = inside.empty() ? 0.0 : std::max(inside.back().to, 0.0);
    widest = std::max(widest, radii[i]);
  }
  std::ranges::fill(hits, widest > 0.0 ? 1 : 0);
  for (double& radius : radii) radius = std::max(radius, kNarrowest * widest);
}

}  // namespace fascicle::muscle
