#include "modules/muscle/asset/fibres/fibre_curves.hpp"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "modules/muscle/asset/fibres/fibre_sheet.hpp"

namespace fascicle::muscle {
namespace {

using Curve = std::vector<glm::dvec3>;

TEST(FibreCurves, OnePlaceIsACurveWithoutLength) {
  const Curve still(4, glm::dvec3(1, 2, 3));
  EXPECT_EQ(curve_length(still), 0.0);
  EXPECT_EQ(resample_curve(still, 3), Curve(3, glm::dvec3(1, 2, 3)));
  EXPECT_EQ(CentripetalCurve(still).at(0.3), glm::dvec3(1, 2, 3));
  EXPECT_EQ(smooth_curve(still), still) << "too few points to smooth";
}

TEST(FibreCurves, ResamplingIsEvenAndKeepsTheEnds) {
  const Curve bent{{0, 0, 0}, {1, 0, 0}, {1, 3, 0}};
  const Curve even = resample_curve(bent, 5);
  ASSERT_EQ(even.size(), 5u);
  EXPECT_EQ(even.front(), bent.front());
  EXPECT_EQ(even.back(), bent.back());
  EXPECT_NEAR(glm::distance(even[1], glm::dvec3(1, 0, 0)), 0.0, 1e-12);
  EXPECT_NEAR(glm::distance(even[2], glm::dvec3(1, 1, 0)), 0.0, 1e-12);
}

TEST(FibreCurves, SmoothingKeepsParabolasAndTakesNoise) {
  Curve parabola, noisy;
  for (int i = 0; i < 20; ++i) {
    parabola.emplace_back(i, 0.5 * i * i - 3.0 * i + 1.0, 2.0);
    noisy.push_back(parabola.back() + glm::dvec3(0, 0, i % 2 == 0 ? 0.1 : -0.1));
  }
  const Curve same = smooth_curve(parabola), smooth = smooth_curve(noisy);
  for (std::size_t i = 0; i < parabola.size(); ++i) {
    EXPECT_NEAR(glm::distance(same[i], parabola[i]), 0.0, 1e-9) << i;
  }
  for (std::size_t i = 3; i < 17; ++i) EXPECT_LT(glm::distance(smooth[i], parabola[i]), 0.05) << i;
}

TEST(FibreCurves, CatmullRomPassesThroughItsPointsWithoutLoops) {
  // Two points all but at one place between distant ones: the uniform curve would loop there.
  const Curve points{{0, 0, 0}, {1, 0, 0}, {1.01, 0.01, 0}, {2, 5, 1}, {2, 5, 1}, {3, 5, 1}};
  const CentripetalCurve curve(points);
  for (std::size_t i = 0; i < points.size(); ++i)
    EXPECT_NEAR(glm::distance(curve.at(curve.knot(i)), points[i]), 0.0, 1e-9) << i;
  EXPECT_EQ(curve.knot(0), 0.0);
  EXPECT_EQ(curve.knot(5), 1.0);
  double x = -1.0;
  for (int i = 0; i <= 200; ++i) {
    const glm::dvec3 p = curve.at(curve.knot(2) * i / 200.0);
    EXPECT_GE(p.x, x) << "it turns back";
    x = p.x;
  }
}

TEST(FibreCurves, CatmullRomOfEvenPointsOnALineIsTheLine) {
  const CentripetalCurve curve(Curve{{0, 0, 0}, {1, 1, 0}, {2, 2, 0}});
  for (const double t : {0.0, 0.1, 0.5, 0.77, 1.0})
    EXPECT_NEAR(glm::distance(curve.at(t), {2 * t, 2 * t, 0}), 0.0, 1e-12);
}

TEST(FibreSheet, PutsFibresSideBySideAndRunsThemOneWay) {
  const auto line = [](double x) { return Curve{{x, 0, 0}, {x, 0, 4}}; };
  std::vector<Curve> fibres{line(2), line(0), line(3), line(1)};
  std::swap(fibres[2].front(), fibres[2].back());
  FibreSheet sheet(fibres);
  const double first = sheet.at(0.0, 0).x, turn = first > 1.5 ? -1.0 : 1.0;
  for (int i = 0; i <= 12; ++i) {
    EXPECT_NEAR(sheet.at(i / 12.0, 5).x, first + turn * i / 4.0, 1e-9);
    EXPECT_NEAR(sheet.at(i / 12.0, 0).z, 0.0, 1e-12);
    EXPECT_NEAR(sheet.at(i / 12.0, FibreSheet::kStations - 1).z, 4.0, 1e-12);
  }
  sheet.turn_round();
  EXPECT_NEAR(sheet.at(0.5, 0).z, 4.0, 1e-12);
}

}  // namespace
}  // namespace fascicle::muscle
