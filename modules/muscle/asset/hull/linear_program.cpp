#include "modules/muscle/asset/hull/linear_program.hpp"

#include <algorithm>
#include <limits>

#include <glm/geometric.hpp>

namespace fascicle::muscle {
namespace {

// Planes whose normals' cross product is shorter have no line in common that could be computed.
constexpr double kParallel = 1.0e-9;

double lack(const HalfSpace& one, const glm::dvec3& point) { return one.offset - glm::dot(one.normal, point); }

// The same on the line through `point`, a point of it, along the unit vector `along`.
std::optional<glm::dvec3> nearest_on_line(std::span<const HalfSpace> half_spaces, const glm::dvec3& point,
                                          const glm::dvec3& along, double wanted, double slack) {
  double low = -std::numeric_limits<double>::infinity(), high = std::numeric_limits<double>::infinity();
  for (const HalfSpace& one : half_spaces) {
    const double slope = glm::dot(one.normal, along), missing = lack(one, point);
    if (slope > kParallel) {
      low = std::max(low, missing / slope);
    } else if (slope < -kParallel) {
      high = std::min(high, missing / slope);
    } else if (missing > slack) {
      return std::nullopt;
    }
  }
  if (low > high + slack) return std::nullopt;
  return point + along * (low > high ? 0.5 * (low + high) : std::clamp(wanted, low, high));
}

// The same on the plane of `bound`.
std::optional<glm::dvec3> nearest_on_plane(std::span<const HalfSpace> half_spaces, const HalfSpace& bound,
                                           const glm::dvec3& target, double slack) {
  glm::dvec3 best = target + bound.normal * lack(bound, target);
  for (std::size_t i = 0; i < half_spaces.size(); ++i) {
    const HalfSpace& one = half_spaces[i];
    const double missing = lack(one, best);
    if (missing <= slack) continue;
    const glm::dvec3 line = glm::cross(bound.normal, one.normal);
    const double sine = glm::length(line);
    if (sine < kParallel) return std::nullopt;
    // The place of the line that is nearest to `best`: along the plane, up to the other.
    const glm::dvec3 along = line / sine;
    const glm::dvec3 ahead = glm::cross(along, bound.normal);
    const glm::dvec3 point = best + ahead * (missing / glm::dot(ahead, one.normal));
    const auto next = nearest_on_line(half_spaces.first(i), point, along, glm::dot(target - point, along), slack);
    if (!next) return std::nullopt;
    best = *next;
  }
  return best;
}

}  // namespace

std::optional<glm::dvec3> nearest_point(std::span<const HalfSpace> half_spaces, const glm::dvec3& target, double slack) {
  glm::dvec3 best = target;
  for (std::size_t i = 0; i < half_spaces.size(); ++i) {
    if (lack(half_spaces[i], best) <= slack) continue;
    const auto next = nearest_on_plane(half_spaces.first(i), half_spaces[i], target, slack);
    if (!next) return std::nullopt;
    best = *next;
  }
  return best;
}

std::optional<glm::dvec3> solve_linear_program(const glm::dvec3& cost, std::span<const HalfSpace> half_spaces,
                                               double reach, double slack) {
  return nearest_point(half_spaces, -reach * cost, slack);
}

}  // namespace fascicle::muscle
