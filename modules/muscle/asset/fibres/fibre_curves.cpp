#include "modules/muscle/asset/fibres/fibre_curves.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace fascicle::muscle {
namespace {

constexpr std::size_t kReach = 3;                   // neighbours on either side in a smoothing window
constexpr std::size_t kWindow = 2 * kReach + 1;

// Weights that give a least-squares parabola's value at `at` (in steps from the window's middle) from the window's
// points.
std::array<double, kWindow> parabola_weights(double at) {
  std::array<double, kWindow> weights{};
  for (std::size_t i = 0; i < kWindow; ++i) {
    const double x = static_cast<double>(i) - static_cast<double>(kReach);
    // Orthogonal polynomials on the window: 1, x, x^2 - 4, with squared norms 7, 28, 84.
    weights[i] = 1.0 / 7.0 + at * x / 28.0 + (at * at - 4.0) * (x * x - 4.0) / 84.0;
  }
  return weights;
}

}  // namespace

double curve_length(std::span<const glm::dvec3> curve) {
  double length = 0.0;
  for (std::size_t i = 1; i < curve.size(); ++i) length += glm::distance(curve[i - 1], curve[i]);
  return length;
}

std::vector<glm::dvec3> resample_curve(std::span<const glm::dvec3> curve, std::size_t count) {
  std::vector<glm::dvec3> even(count, curve.back());
  even.front() = curve.front();
  const double length = curve_length(curve);
  std::size_t segment = 0;
  double begin = 0.0, size = curve.size() > 1 ? glm::distance(curve[0], curve[1]) : 0.0;
  for (std::size_t i = 1; i + 1 < count; ++i) {
    const double at = length * static_cast<double>(i) / static_cast<double>(count - 1);
    while (begin + size < at && segment + 2 < curve.size()) {
      begin += size;
      ++segment;
      size = glm::distance(curve[segment], curve[segment + 1]);
    }
    const double t = size > 0.0 ? glm::clamp((at - begin) / size, 0.0, 1.0) : 0.0;
    even[i] = glm::mix(curve[segment], curve[std::min(segment + 1, curve.size() - 1)], t);
  }
  return even;
}

std::vector<glm::dvec3> smooth_curve(std::span<const glm::dvec3> curve) {
  std::vector<glm::dvec3> smooth(curve.begin(), curve.end());
  if (curve.size() < kWindow) return smooth;
  for (std::size_t i = 0; i < curve.size(); ++i) {
    const std::size_t middle = std::clamp(i, kReach, curve.size() - 1 - kReach);
    const auto weights = parabola_weights(static_cast<double>(i) - static_cast<double>(middle));
    smooth[i] = glm::dvec3(0.0);
    for (std::size_t k = 0; k < kWindow; ++k) smooth[i] += weights[k] * curve[middle - kReach + k];
  }
  return smooth;
}

CentripetalCurve::CentripetalCurve(std::span<const glm::dvec3> points) {
  for (const glm::dvec3& p : points) {
    if (points_.empty() || p != points_.back()) {
      knots_.push_back(points_.empty() ? 0.0 : knots_.back() + std::sqrt(glm::distance(points_.back(), p)));
      points_.push_back(p);
    }
    of_point_.push_back(knots_.back());
  }
  const double last = knots_.back();
  if (!(last > 0.0)) return;
  for (double& knot : knots_) knot /= last;
  for (double& knot : of_point_) knot /= last;
}

glm::dvec3 CentripetalCurve::at(double t) const {
  const std::size_t n = points_.size();
  if (n == 1) return points_.front();
  t = glm::clamp(t, 0.0, 1.0);
  const auto above = static_cast<std::size_t>(std::ranges::upper_bound(knots_, t) - knots_.begin());
  const std::size_t i = std::clamp<std::size_t>(above, 1, n - 1) - 1;
  const glm::dvec3 &b = points_[i], &c = points_[i + 1];
  const glm::dvec3 a = i > 0 ? points_[i - 1] : 2.0 * b - c, d = i + 2 < n ? points_[i + 2] : 2.0 * c - b;
  const double tb = knots_[i], tc = knots_[i + 1];
  const double ta = i > 0 ? knots_[i - 1] : 2.0 * tb - tc, td = i + 2 < n ? knots_[i + 2] : 2.0 * tc - tb;
  // Barry and Goldman's pyramid of linear interpolations.
  const auto between = [&](const glm::dvec3& p, const glm::dvec3& q, double tp, double tq) {
    return ((tq - t) * p + (t - tp) * q) / (tq - tp);
  };
  const glm::dvec3 ab = between(a, b, ta, tb), bc = between(b, c, tb, tc), cd = between(c, d, tc, td);
  return between(between(ab, bc, ta, tc), between(bc, cd, tb, td), tb, tc);
}

}  // namespace fascicle::muscle
