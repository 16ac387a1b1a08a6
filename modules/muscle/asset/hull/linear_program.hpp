// Linear programs in three variables with few constraints: where between half-spaces is a direction's least value?
#pragma once

#include <optional>
#include <span>

#include <glm/vec3.hpp>

namespace fascicle::muscle {

// All x with normal . x >= offset.
struct HalfSpace {
  glm::dvec3 normal{0.0};  // unit
  double offset = 0.0;
};

// The point that is in all half-spaces and nearest to `target`, or none where the half-spaces have nothing in common
// (to within `slack`, by which the result may be outside of some). By Seidel's incremental method: each half-space that
// the best point so far is outside of puts the new one on its plane. Time linear in the number of half-spaces on
// average, cubic at worst.
std::optional<glm::dvec3> nearest_point(std::span<const HalfSpace> half_spaces, const glm::dvec3& target, double slack);

// The point in all half-spaces at which cost . x is least, and of several such points the one nearest to the origin.
// The program is solved as the nearest point to one that is `reach` away against the cost: that is exact where `reach`
// is large beside the solution's distance from the origin and the planes are not nearly level; then points far away for
// little gain are passed over, and no program is unbounded. `cost` counts relative to `reach`: give it a length of one
// or so.
std::optional<glm::dvec3> solve_linear_program(const glm::dvec3& cost, std::span<const HalfSpace> half_spaces,
                                               double reach, double slack);

}  // namespace fascicle::muscle
