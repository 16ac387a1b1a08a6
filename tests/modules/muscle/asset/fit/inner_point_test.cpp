#include "modules/muscle/asset/fit/inner_point.hpp"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "modules/muscle/asset/fit/section_rays.hpp"

namespace fascicle::muscle {
namespace {

// Match i+ goes from `near` to `far` along its ray.
struct Match {
  std::uint32_t vertex;
  double near, far;
};

glm::dvec2 point(std::uint32_t count, const std::vector<Match>& matches) {
  std::vector<double> radii(count, 1.0);
  std::vector<std::uint32_t> ordered;
  for (const Match& match : matches) {
    radii[match.vertex] = match.far;
    radii[(match.vertex + count / 2) % count] = -match.near;
    ordered.push_back(match.vertex);
  }
  return inner_point(ordered, radii, ray_directions(count));
}

TEST(InnerPoint, WithoutMatchesTheCentreStays) { EXPECT_EQ(point(8, {}), glm::dvec2(0.0)); }

TEST(InnerPoint, OfAnOddNumberIsTheMiddleOfTheMiddleMatch) {
  const glm::dvec2 one = point(8, {{2, 1.0, 4.0}});
  EXPECT_NEAR(one.x, 0.0, 1e-12);
  EXPECT_NEAR(one.y, 2.5, 1e-12);
  const glm::dvec2 three = point(8, {{7, 0.1, 9.0}, {0, 1.0, 2.0}, {1, 0.3, 7.0}});
  EXPECT_NEAR(three.x, 1.5, 1e-12);
  EXPECT_NEAR(three.y, 0.0, 1e-12);
}

TEST(InnerPoint, OfAnEvenNumberIsTheAreaCentroidOfTheTwoMiddleOnes) {
  // Rays at 0 and 90 degrees from 1 to 3: the triangle with legs 3 less that with legs 1.
  const glm::dvec2 two = point(8, {{0, 1.0, 3.0}, {2, 1.0, 3.0}});
  const double wanted = (4.5 * 1.0 - 0.5 / 3.0) / 4.0;  // the vertices' mean would be 1
  EXPECT_NEAR(two.x, wanted, 1e-12);
  EXPECT_NEAR(two.y, wanted, 1e-12);
  const glm::dvec2 four = point(8, {{7, 0.2, 0.4}, {0, 1.0, 3.0}, {2, 1.0, 3.0}, {3, 5.0, 6.0}});
  EXPECT_NEAR(four.x, wanted, 1e-12);
  EXPECT_NEAR(four.y, wanted, 1e-12);
}

TEST(InnerPoint, AQuadrilateralWithoutAreaGivesItsMean) {
  const glm::dvec2 thin = point(8, {{0, 2.0, 2.0}, {2, 2.0, 2.0}});
  EXPECT_NEAR(thin.x, 1.0, 1e-12);
  EXPECT_NEAR(thin.y, 1.0, 1e-12);
  const glm::dvec2 none = point(8, {{0, 0.0, 0.0}, {2, 0.0, 0.0}});
  EXPECT_EQ(none, glm::dvec2(0.0));
}

}  // namespace
}  // namespace fascicle::muscle
