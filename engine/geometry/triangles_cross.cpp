#include "engine/geometry/triangles_cross.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

namespace fascicle {
namespace {

using Corners = std::array<glm::dvec3, 3>;

// Shewchuk's static bounds for the rounding error of 3x3 and 2x2 determinants, with room to spare.
constexpr double kEpsilon = std::numeric_limits<double>::epsilon() / 2.0;
constexpr double kSpaceError = 16.0 * kEpsilon;
constexpr double kPlaneError = 8.0 * kEpsilon;

int sign_beyond(double value, double error) { return value > error ? 1 : value < -error ? -1 : 0; }

// On which side of the plane a, b, c the point p lies; 0: on it, as far as can be told.
int side_of_plane(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c, const glm::dvec3& p) {
  const glm::dvec3 u = a - p, v = b - p, w = c - p;
  const double det = glm::dot(u, glm::cross(v, w));
  const glm::dvec3 au = glm::abs(u), av = glm::abs(v), aw = glm::abs(w);
  const double size =
      au.x * (av.y * aw.z + av.z * aw.y) + au.y * (av.z * aw.x + av.x * aw.z) + au.z * (av.x * aw.y + av.y * aw.x);
  return sign_beyond(det, kSpaceError * size);
}

using Sides = std::array<int, 3>;

// On which side of the plane of `plane` the corners of `of` lie.
Sides sides_of(const Corners& plane, const Corners& of) {
  Sides sides;
  for (std::size_t k = 0; k < 3; ++k) sides[k] = side_of_plane(plane[0], plane[1], plane[2], of[k]);
  return sides;
}

bool has(const Sides& sides, int side) { return std::ranges::find(sides, side) != sides.end(); }

// Whether the line p, q passes through the triangle or touches its rim.
bool line_meets(const glm::dvec3& p, const glm::dvec3& q, const Corners& t) {
  const Sides sides = {side_of_plane(p, q, t[0], t[1]), side_of_plane(p, q, t[1], t[2]),
                       side_of_plane(p, q, t[2], t[0])};
  return has(sides, 1) != has(sides, -1);
}

// Whether an edge of `of` passes through `through`, ends not counted.
bool any_edge_passes(const Corners& of, const Sides& sides, const Corners& through) {
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t next = (k + 1) % 3;
    if (sides[k] * sides[next] < 0 && line_meets(of[k], of[next], through)) return true;
  }
  return false;
}

int turn(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c) {
  const glm::dvec2 u = b - a, v = c - a;
  return sign_beyond(u.x * v.y - u.y * v.x, kPlaneError * (std::abs(u.x * v.y) + std::abs(u.y * v.x)));
}

// Whether an edge of `first` has all of `second` on its outer side.
bool separates(const std::array<glm::dvec2, 3>& first, const std::array<glm::dvec2, 3>& second) {
  const int sense = turn(first[0], first[1], first[2]);
  for (std::size_t k = 0; k < 3; ++k) {
    if (std::ranges::all_of(second,
                            [&](const glm::dvec2& p) { return sense * turn(first[k], first[(k + 1) % 3], p) <= 0; })) {
      return true;
    }
  }
  return false;
}

// For triangles in one plane: whether they share an area. Seen along the axis that the plane faces most.
bool areas_overlap(const Corners& first, const Corners& second) {
  const glm::dvec3 normal = glm::abs(glm::cross(first[1] - first[0], first[2] - first[0]));
  const int along = normal.x >= normal.y && normal.x >= normal.z ? 0 : normal.y >= normal.z ? 1 : 2;
  const auto flatten = [&](const Corners& t) {
    std::array<glm::dvec2, 3> flat;
    for (std::size_t k = 0; k < 3; ++k) flat[k] = {t[k][(along + 1) % 3], t[k][(along + 2) % 3]};
    return flat;
  };
  const auto a = flatten(first), b = flatten(second);
  return !separates(a, b) && !separates(b, a);
}

}  // namespace

bool triangles_cross(std::span<const glm::vec3> positions, const std::array<std::uint32_t, 3>& first,
                     const std::array<std::uint32_t, 3>& second) {
  const auto corners = [&](const std::array<std::uint32_t, 3>& t) {
    return Corners{glm::dvec3(positions[t[0]]), glm::dvec3(positions[t[1]]), glm::dvec3(positions[t[2]])};
  };
  const Corners a = corners(first), b = corners(second);
  // A corner in common gives a determinant of exactly zero: one of its differences is.
  const Sides sides_b = sides_of(a, b);
  if (!has(sides_b, 1) && !has(sides_b, -1)) return areas_overlap(a, b);
  if (!has(sides_b, 1) || !has(sides_b, -1)) return false;  // all on one side: they touch at most
  const Sides sides_a = sides_of(b, a);
  if (!has(sides_a, 1) || !has(sides_a, -1)) return false;
  return any_edge_passes(a, sides_a, b) || any_edge_passes(b, sides_b, a);
}

}  // namespace fascicle
