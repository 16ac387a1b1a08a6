#include "engine/animation/scalar_function.hpp"

#include <cmath>
#include <limits>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace fascicle {
namespace {

using testing::HasSubstr;

TEST(ScalarFunction, NamesWhatIsWrongWithKnots) {
  const std::vector<double> rising{0.0, 1.0, 2.0};
  EXPECT_THAT(fault_of_knots(rising, std::vector<double>{0.0, 1.0}), HasSubstr("3 x values but 2 y values"));
  EXPECT_THAT(fault_of_knots({}, {}), HasSubstr("0 points"));
  EXPECT_THAT(fault_of_knots(std::vector<double>{0.0, 0.0}, std::vector<double>{0.0, 1.0}),
              HasSubstr("repeats at point 1"));
  EXPECT_THAT(fault_of_knots(std::vector<double>{0.0, 1e-12}, std::vector<double>{0.0, 1.0}),
              HasSubstr("less than 1e-9"));
  EXPECT_THAT(fault_of_knots(std::vector<double>{0.0, std::nan("")}, std::vector<double>{0.0, 1.0}),
              HasSubstr("not finite"));
  EXPECT_THAT(fault_of_knots(std::vector<double>{0.0, 1e10}, std::vector<double>{0.0, 1.0}), HasSubstr("beyond 1e9"));
  EXPECT_THAT(fault_of_knots(std::vector<double>{-1e10, 0.0}, std::vector<double>{0.0, 1.0}), HasSubstr("beyond 1e9"));
  EXPECT_EQ(fault_of_knots(rising, rising), "");
}

TEST(ScalarFunction, EvaluatesClosedForms) {
  EXPECT_EQ(ScalarFunction()(3.0), 0.0);
  EXPECT_EQ(ScalarFunction::constant(2.5)(-7.0), 2.5);
  EXPECT_EQ(ScalarFunction::linear(2.0, -1.0)(3.0), 5.0);
  EXPECT_EQ(ScalarFunction::polynomial({1.0, 2.0, 3.0})(2.0), 11.0);  // x^2 + 2x + 3
  EXPECT_EQ(ScalarFunction::polynomial({1.0, 2.0, 3.0}).derivative(2.0), 6.0);
  const auto pieces = ScalarFunction::piecewise_linear({0.0, 1.0, 3.0}, {0.0, 2.0, 0.0});
  EXPECT_DOUBLE_EQ(pieces(0.5), 1.0);
  EXPECT_DOUBLE_EQ(pieces(2.0), 1.0);
  EXPECT_DOUBLE_EQ(pieces(-1.0), -2.0);
  EXPECT_DOUBLE_EQ(pieces(4.0), -1.0);
}

// A spline with these end conditions reproduces every cubic; a natural one would not.
TEST(ScalarFunction, SplineReproducesCubics) {
  const auto cubic = [](double x) { return 0.3 * x * x * x - x * x + 0.5 * x + 2.0; };
  const auto slope = [](double x) { return 0.9 * x * x - 2.0 * x + 0.5; };
  const std::vector<double> x{-2.0, -1.7, -0.4, 0.1, 1.5, 2.0};
  std::vector<double> y;
  for (const double each : x) y.push_back(cubic(each));
  const auto spline = ScalarFunction::spline(x, y);
  for (double at = -2.0; at <= 2.0; at += 0.05) {
    EXPECT_NEAR(spline(at), cubic(at), 1e-13) << at;
    EXPECT_NEAR(spline.derivative(at), slope(at), 1e-12) << at;
  }
}

TEST(ScalarFunction, SplineOfThreePointsIsTheirParabolaAndOfTwoTheirLine) {
  const auto parabola = ScalarFunction::spline({0.0, 1.0, 3.0}, {0.0, 1.0, 9.0});
  EXPECT_NEAR(parabola(0.5), 0.25, 1e-15);
  EXPECT_NEAR(parabola(2.0), 4.0, 1e-14);
  const auto line = ScalarFunction::spline({0.0, 2.0}, {1.0, 5.0});
  EXPECT_DOUBLE_EQ(line(1.0), 3.0);
  EXPECT_DOUBLE_EQ(line(-1.0), -1.0);
  EXPECT_EQ(line.kind(), ScalarFunction::Kind::kSpline);
}

TEST(ScalarFunction, SplinePassesItsPointsSmoothlyAndGoesOnStraight) {
  const std::vector<double> x{-2.1, -1.2, -0.7, 0.0, 0.2, 0.4};
  const std::vector<double> y{0.01, 0.03, -0.02, 0.0, 0.05, 0.01};
  const auto spline = ScalarFunction::spline(x, y);
  for (std::size_t i = 0; i < x.size(); ++i) EXPECT_NEAR(spline(x[i]), y[i], 1e-16);
  for (std::size_t i = 1; i + 1 < x.size(); ++i) {
    EXPECT_NEAR(spline.derivative(x[i] - 1e-9), spline.derivative(x[i] + 1e-9), 1e-6);
  }
  const double end_slope = spline.derivative(0.4);
  EXPECT_NEAR(spline(1.4), 0.01 + end_slope, 1e-14);
  EXPECT_EQ(spline.derivative(5.0), end_slope);
  EXPECT_NEAR(spline(-3.1), 0.01 - spline.derivative(-2.1), 1e-14);
}

TEST(ScalarFunction, DerivativesAgreeWithDifferences) {
  const ScalarFunction functions[] = {ScalarFunction::constant(1.0), ScalarFunction::linear(3.0, 1.0),
                                      ScalarFunction::polynomial({1.0, -2.0, 0.5, 3.0}),
                                      ScalarFunction::piecewise_linear({-1.0, 0.0, 1.0}, {1.0, -1.0, 4.0}),
                                      ScalarFunction::spline({-1.0, -0.3, 0.2, 1.0}, {1.0, -1.0, 4.0, 0.0})};
  for (const ScalarFunction& function : functions) {
    for (double x = -1.55; x < 1.6; x += 0.1) {
      const double difference = (function(x + 1e-6) - function(x - 1e-6)) / 2e-6;
      EXPECT_NEAR(function.derivative(x), difference, 1e-6 * (1.0 + std::abs(difference)));
      EXPECT_NEAR(function.scaled(-2.0)(x), -2.0 * function(x), 1e-14);
      EXPECT_NEAR(function.scaled(-2.0).derivative(x), -2.0 * function.derivative(x), 1e-13);
    }
  }
}

}  // namespace
}  // namespace fascicle
