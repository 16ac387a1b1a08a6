#include "modules/muscle/asset/fibres/fibre_template.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/common.hpp>

namespace fascicle::muscle {
namespace {

constexpr double kFanEnd = 0.25;          // of the disc's radius, at the insertion
constexpr double kShortestPennate = 0.2;  // of the length that a whole fibre has: shorter ones are left out
// The two-dimensional golden ratio's powers: multiples of them, less their whole parts, spread evenly over a square.
constexpr double kSpreadX = 0.7548776662466927;
constexpr double kSpreadY = 0.5698402909980532;

TemplateFibre straight(const glm::dvec3& from, const glm::dvec3& to) {
  return {{from, glm::mix(from, to, 1.0 / 3.0), glm::mix(from, to, 2.0 / 3.0), to}};
}

std::vector<TemplateFibre> make_pennate(std::uint32_t count, double slope) {
  std::vector<TemplateFibre> fibres;
  fibres.reserve(count);
  // A fibre is x = x0 + slope z at one y: x0 and y evenly spread make every cross-section evenly filled.
  for (std::uint64_t i = 1; fibres.size() < count; ++i) {
    const double sx = std::fmod(0.5 + kSpreadX * static_cast<double>(i), 1.0);
    const double sy = std::fmod(0.5 + kSpreadY * static_cast<double>(i), 1.0);
    const double y = kTemplateRadius * (2.0 * sy - 1.0);
    const double x0 = glm::mix(-kTemplateRadius - slope, kTemplateRadius, sx);
    const double half = std::sqrt(std::max(kTemplateRadius * kTemplateRadius - y * y, 0.0));
    const double begin = std::max(0.0, (-half - x0) / slope), end = std::min(1.0, (half - x0) / slope);
    if (end - begin < kShortestPennate * std::min(1.0, 2.0 * half / slope) || !(end > begin)) continue;
    fibres.push_back(straight({x0 + slope * begin, y, begin}, {x0 + slope * end, y, end}));
  }
  return fibres;
}

}  // namespace

glm::dvec3 TemplateFibre::at(double t) const {
  const double s = 1.0 - t;
  return s * s * s * control[0] + 3.0 * s * s * t * control[1] + 3.0 * s * t * t * control[2] + t * t * t * control[3];
}

std::vector<glm::dvec2> spread_over_disc(std::uint32_t count) {
  // Vogel's sunflower: equal areas along a spiral by the golden angle.
  const double golden = std::numbers::pi * (3.0 - std::sqrt(5.0));
  std::vector<glm::dvec2> points(count);
  for (std::uint32_t i = 0; i < count; ++i) {
    const double radius = kTemplateRadius * std::sqrt((i + 0.5) / count);
    points[i] = radius * glm::dvec2(std::cos(golden * i), std::sin(golden * i));
  }
  return points;
}

std::vector<TemplateFibre> make_template(FibreArrangement arrangement, std::uint32_t count, double slope) {
  if (arrangement == FibreArrangement::kPennate && slope > 1.0e-6) return make_pennate(count, slope);
  const double end = arrangement == FibreArrangement::kFan ? kFanEnd : 1.0;
  std::vector<TemplateFibre> fibres;
  fibres.reserve(count);
  for (const glm::dvec2& p : spread_over_disc(count))
    fibres.push_back(straight({p.x, p.y, 0.0}, {end * p.x, end * p.y, 1.0}));
  return fibres;
}

}  // namespace fascicle::muscle
