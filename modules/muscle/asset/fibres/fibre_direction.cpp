#include "modules/muscle/asset/fibres/fibre_direction.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace fascicle::muscle {
namespace {

constexpr double kStep = 1.0e-3;  // m

}  // namespace

DirectionError measure_direction(const FibreBundleAsset& bundle, std::span<const FibreLine> given) {
  DirectionError error;
  if (bundle.count == 0) return error;
  const auto ask = [&](const glm::dvec3& place, const glm::dvec3& along) {
    double nearest = std::numeric_limits<double>::max();
    glm::dvec3 direction(0.0);
    for (std::size_t i = 0; i + 1 < bundle.rest_points.size(); ++i) {
      if ((i + 1) % bundle.points_per_fibre == 0) continue;  // from one fibre's end to the next one's beginning
      const glm::dvec3 a(bundle.rest_points[i]), way = glm::dvec3(bundle.rest_points[i + 1]) - a;
      const double square = glm::dot(way, way);
      if (!(square > 0.0)) continue;
      const glm::dvec3 off = place - (a + glm::clamp(glm::dot(place - a, way) / square, 0.0, 1.0) * way);
      if (glm::dot(off, off) >= nearest) continue;
      nearest = glm::dot(off, off);
      direction = way / std::sqrt(square);
    }
    if (direction == glm::dvec3(0.0)) return;
    const double angle = std::acos(std::min(std::abs(glm::dot(along, direction)), 1.0));
    error.mean += angle;
    error.max = std::max(error.max, angle);
    error.distance += std::sqrt(nearest);
    ++error.places;
  };
  for (const FibreLine& fibre : given) {
    for (std::size_t i = 0; i + 1 < fibre.points.size(); ++i) {
      const glm::dvec3 a(fibre.points[i]), b(fibre.points[i + 1]);
      const double length = glm::distance(a, b);
      if (!(length > 0.0)) continue;
      const auto steps = static_cast<std::size_t>(std::max(1.0, std::floor(length / kStep)));
      for (std::size_t k = 0; k < steps; ++k)
        ask(glm::mix(a, b, (static_cast<double>(k) + 0.5) / static_cast<double>(steps)), (b - a) / length);
    }
  }
  if (error.places > 0) {
    error.mean /= static_cast<double>(error.places);
    error.distance /= static_cast<double>(error.places);
  }
  return error;
}

}  // namespace fascicle::muscle
