#include "engine/animation/scalar_function.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

#include <fmt/format.h>

namespace fascicle {
namespace {

// The divided difference y[x_i, x_i+1, x_i+2, x_i+3]: a sixth of the third derivative of the cubic through four points.
double third_difference(std::span<const double> x, std::span<const double> y, std::size_t i) {
  const double first = (y[i + 1] - y[i]) / (x[i + 1] - x[i]);
  const double second = (y[i + 2] - y[i + 1]) / (x[i + 2] - x[i + 1]);
  const double third = (y[i + 3] - y[i + 2]) / (x[i + 3] - x[i + 2]);
  return ((third - second) / (x[i + 3] - x[i + 1]) - (second - first) / (x[i + 2] - x[i])) / (x[i + 3] - x[i]);
}

// A sixth of the spline's second derivative at each knot: a tridiagonal system whose inner rows ask for continuous
// slopes and whose first and last ask for the third derivative of the cubic through the four end points.
std::vector<double> sixth_of_curvature(std::span<const double> x, std::span<const double> y) {
  const std::size_t n = x.size();
  std::vector<double> diagonal(n);
  std::vector<double> sigma(n);  // right-hand side, then the solution
  const double h_first = x[1] - x[0];
  const double h_last = x[n - 1] - x[n - 2];
  diagonal[0] = -h_first;
  diagonal[n - 1] = -h_last;
  if (n > 3) {
    sigma[0] = h_first * h_first * third_difference(x, y, 0);
    sigma[n - 1] = -h_last * h_last * third_difference(x, y, n - 4);
  }
  for (std::size_t i = 1; i + 1 < n; ++i) {
    const double h_before = x[i] - x[i - 1];
    const double h_after = x[i + 1] - x[i];
    diagonal[i] = 2.0 * (h_before + h_after);
    sigma[i] = (y[i + 1] - y[i]) / h_after - (y[i] - y[i - 1]) / h_before;
  }
  // Off-diagonal entries are the interval lengths h, above and below alike.
  for (std::size_t i = 1; i < n; ++i) {
    const double h = x[i] - x[i - 1];
    const double factor = h / diagonal[i - 1];
    diagonal[i] -= factor * h;
    sigma[i] -= factor * sigma[i - 1];
  }
  sigma[n - 1] /= diagonal[n - 1];
  for (std::size_t i = n - 1; i-- > 0;) sigma[i] = (sigma[i] - (x[i + 1] - x[i]) * sigma[i + 1]) / diagonal[i];
  return sigma;
}

}  // namespace

ScalarFunction ScalarFunction::constant(double value) {
  ScalarFunction function;
  function.coefficients_ = {value};
  return function;
}

ScalarFunction ScalarFunction::linear(double slope, double intercept) {
  ScalarFunction function;
  function.kind_ = Kind::kLinear;
  function.coefficients_ = {slope, intercept};
  return function;
}

ScalarFunction ScalarFunction::polynomial(std::vector<double> coefficients) {
  assert(!coefficients.empty());
  ScalarFunction function;
  function.kind_ = Kind::kPolynomial;
  function.coefficients_ = std::move(coefficients);
  return function;
}

ScalarFunction ScalarFunction::piecewise_linear(std::vector<double> x, std::vector<double> y) {
  assert(fault_of_knots(x, y).empty());
  ScalarFunction function;
  function.kind_ = Kind::kPiecewiseLinear;
  function.coefficients_.clear();
  const std::size_t n = x.size();
  function.b_.resize(n);
  function.c_.assign(n, 0.0);
  function.d_.assign(n, 0.0);
  for (std::size_t i = 0; i + 1 < n; ++i) function.b_[i] = (y[i + 1] - y[i]) / (x[i + 1] - x[i]);
  function.b_[n - 1] = function.b_[n - 2];
  function.x_ = std::move(x);
  function.y_ = std::move(y);
  return function;
}

ScalarFunction ScalarFunction::spline(std::vector<double> x, std::vector<double> y) {
  assert(fault_of_knots(x, y).empty());
  if (x.size() == 2) {
    ScalarFunction line = piecewise_linear(std::move(x), std::move(y));
    line.kind_ = Kind::kSpline;
    return line;
  }
  ScalarFunction function;
  function.kind_ = Kind::kSpline;
  function.coefficients_.clear();
  const std::size_t n = x.size();
  const std::vector<double> sigma = sixth_of_curvature(x, y);
  function.b_.resize(n);
  function.c_.resize(n);
  function.d_.resize(n);
  for (std::size_t i = 0; i + 1 < n; ++i) {
    const double h = x[i + 1] - x[i];
    function.b_[i] = (y[i + 1] - y[i]) / h - h * (sigma[i + 1] + 2.0 * sigma[i]);
    function.c_[i] = 3.0 * sigma[i];
    function.d_[i] = (sigma[i + 1] - sigma[i]) / h;
  }
  const double h = x[n - 1] - x[n - 2];
  function.b_[n - 1] = (y[n - 1] - y[n - 2]) / h + h * (sigma[n - 2] + 2.0 * sigma[n - 1]);
  function.x_ = std::move(x);
  function.y_ = std::move(y);
  return function;
}

// The interval that holds x, for x within the knots.
std::size_t ScalarFunction::interval(double x) const {
  const auto after = std::upper_bound(x_.begin(), x_.end(), x);
  const auto index = static_cast<std::size_t>(after - x_.begin());
  return std::min(index == 0 ? 0 : index - 1, x_.size() - 2);
}

double ScalarFunction::operator()(double x) const {
  switch (kind_) {
    case Kind::kConstant:
      return coefficients_[0];
    case Kind::kLinear:
      return coefficients_[0] * x + coefficients_[1];
    case Kind::kPolynomial: {
      double value = 0.0;
      for (const double coefficient : coefficients_) value = value * x + coefficient;
      return value;
    }
    case Kind::kPiecewiseLinear:
    case Kind::kSpline: {
      if (x <= x_.front()) return y_.front() + b_.front() * (x - x_.front());
      if (x >= x_.back()) return y_.back() + b_.back() * (x - x_.back());
      const std::size_t i = interval(x);
      const double t = x - x_[i];
      return y_[i] + t * (b_[i] + t * (c_[i] + t * d_[i]));
    }
  }
  return 0.0;
}

double ScalarFunction::derivative(double x) const {
  switch (kind_) {
    case Kind::kConstant:
      return 0.0;
    case Kind::kLinear:
      return coefficients_[0];
    case Kind::kPolynomial: {
      double value = 0.0;
      double slope = 0.0;
      for (const double coefficient : coefficients_) {
        slope = slope * x + value;
        value = value * x + coefficient;
      }
      return slope;
    }
    case Kind::kPiecewiseLinear:
    case Kind::kSpline: {
      if (x <= x_.front()) return b_.front();
      if (x >= x_.back()) return b_.back();
      const std::size_t i = interval(x);
      const double t = x - x_[i];
      return b_[i] + t * (2.0 * c_[i] + t * 3.0 * d_[i]);
    }
  }
  return 0.0;
}

bool ScalarFunction::is_zero() const { return kind_ == Kind::kConstant && coefficients_[0] == 0.0; }

ScalarFunction ScalarFunction::scaled(double factor) const {
  ScalarFunction result = *this;
  for (auto* values : {&result.coefficients_, &result.y_, &result.b_, &result.c_, &result.d_}) {
    for (double& value : *values) value *= factor;
  }
  return result;
}

std::string fault_of_knots(std::span<const double> x, std::span<const double> y) {
  if (x.size() != y.size()) return fmt::format("{} x values but {} y values", x.size(), y.size());
  if (x.size() < 2) return fmt::format("{} point{}, where at least 2 are needed", x.size(), x.size() == 1 ? "" : "s");
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (!std::isfinite(x[i]) || !std::isfinite(y[i])) return fmt::format("point {} is not finite", i);
    if (i == 0) continue;
    if (x[i] <= x[i - 1]) return fmt::format("x falls or repeats at point {} ({} after {})", i, x[i], x[i - 1]);
    // Intervals of 1e-9 and slopes beyond 1e12 are no joint's; they would overflow in the spline's differences.
    if (x[i] - x[i - 1] < 1e-9) return fmt::format("points {} and {} are less than 1e-9 apart in x", i - 1, i);
    if (std::abs(x[i]) > 1e9 || std::abs(y[i]) > 1e9) return fmt::format("point {} lies beyond 1e9", i);
  }
  if (std::abs(x[0]) > 1e9 || std::abs(y[0]) > 1e9) return "point 0 lies beyond 1e9";
  return {};
}

}  // namespace fascicle
