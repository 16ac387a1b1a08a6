// Fibres as both methods make them, before they are bound: polylines with the same number of points each. And the
// operations on single curves that both need.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

namespace fascicle::muscle {

struct FibreCurves {
  std::uint32_t points_per_fibre = 0;
  std::vector<glm::dvec3> points;     // m, rest space, fibre after fibre, from the origin
  std::vector<std::uint32_t> head;    // by fibre
};

double curve_length(std::span<const glm::dvec3> curve);

// `count` points evenly spaced along it, the first and the last its own.
std::vector<glm::dvec3> resample_curve(std::span<const glm::dvec3> curve, std::size_t count);

// Every point becomes what a parabola through it and its three neighbours on either side, by least squares, has there;
// at the ends the parabola of the nearest seven. Straight lines and parabolas stay. Fewer than seven points: as it is.
std::vector<glm::dvec3> smooth_curve(std::span<const glm::dvec3> curve);

// The point (m) at `t`, 0 the first knot and 1 the last, of the centripetal Catmull-Rom curve through the points
// (Yuksel, Schaefer & Keyser 2011): no cusps and no loops between them. The ends go on by reflection. Two points or
// more; points at one place count once.
class CentripetalCurve {
 public:
  explicit CentripetalCurve(std::span<const glm::dvec3> points);

  glm::dvec3 at(double t) const;
  double knot(std::size_t point) const { return of_point_[point]; }  // t of a point

 private:
  std::vector<glm::dvec3> points_;
  std::vector<double> knots_;     // rising, 0..1
  std::vector<double> of_point_;  // of the points as given
};

}  // namespace fascicle::muscle
