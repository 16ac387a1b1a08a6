// A function of one variable, as the joints of a biomechanical model use it: constant, linear, polynomial, piecewise
// linear, or a cubic spline. Evaluated in double precision, with its derivative, and finite for every finite argument.
//
// The spline is the one that OpenSim calls SimmSpline (formerly NaturalCubicSpline). In spite of that name its ends are
// not natural: the third derivative at each end is that of the cubic through the four points there (Forsythe, Malcolm
// and Moler 1977, chapter 4). Three points give a parabola, two a line. Outside its points it goes on straight.
#pragma once

#include <span>
#include <string>
#include <vector>

namespace fascicle {

class ScalarFunction {
 public:
  enum class Kind { kConstant, kLinear, kPolynomial, kPiecewiseLinear, kSpline };

  ScalarFunction() = default;  // the constant 0
  static ScalarFunction constant(double value);
  static ScalarFunction linear(double slope, double intercept);
  // Coefficients of falling powers, as OpenSim lists them: {1, 2, 3} is x^2 + 2x + 3. At least one.
  static ScalarFunction polynomial(std::vector<double> coefficients);
  // Both take knots that `fault_of_knots` finds nothing wrong with.
  static ScalarFunction piecewise_linear(std::vector<double> x, std::vector<double> y);
  static ScalarFunction spline(std::vector<double> x, std::vector<double> y);

  double operator()(double x) const;
  double derivative(double x) const;

  Kind kind() const { return kind_; }
  bool is_zero() const;  // the constant 0
  // constant: {value}; linear: {slope, intercept}; polynomial: falling powers; else empty.
  std::span<const double> coefficients() const { return coefficients_; }
  std::span<const double> x() const { return x_; }  // knots; empty where there are none
  std::span<const double> y() const { return y_; }

  // The same function times `factor`.
  ScalarFunction scaled(double factor) const;

 private:
  std::size_t interval(double x) const;

  Kind kind_ = Kind::kConstant;
  std::vector<double> coefficients_{0.0};
  std::vector<double> x_;
  std::vector<double> y_;
  // Of the cubic y_i + b t + c t^2 + d t^3, t = x - x_i, on the interval from knot i; b also for the last knot.
  std::vector<double> b_;
  std::vector<double> c_;
  std::vector<double> d_;
};

// What keeps these knots from making a piecewise function, in words; empty where nothing does: at least two, as many
// x as y, finite, x strictly rising, and slopes between neighbours that stay finite.
std::string fault_of_knots(std::span<const double> x, std::span<const double> y);

}  // namespace fascicle
