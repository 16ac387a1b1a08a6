#include "modules/muscle/asset/fit/fill_misses.hpp"

#include <vector>

#include <gtest/gtest.h>

namespace fascicle::muscle {
namespace {

TEST(FillMisses, HitsStay) {
  std::vector<double> radii{1, 2, 3, 4, 5, -6};
  const std::vector<double> before = radii;
  fill_misses(6, std::vector<double>{0.0}, std::vector<std::uint8_t>(6, 1), radii);
  EXPECT_EQ(radii, before);
}

TEST(FillMisses, GapsInASectionAreInterpolatedRoundIt) {
  std::vector<double> radii{0, 2, 0, 0, 5, 0};
  fill_misses(6, std::vector<double>{0.0}, std::vector<std::uint8_t>{0, 1, 0, 0, 1, 0}, radii);
  EXPECT_DOUBLE_EQ(radii[2], 3.0);
  EXPECT_DOUBLE_EQ(radii[3], 4.0);
  EXPECT_DOUBLE_EQ(radii[5], 4.0);
  EXPECT_DOUBLE_EQ(radii[0], 3.0);
}

TEST(FillMisses, OneHitServesTheWholeSection) {
  std::vector<double> radii{0, 0, 0, 7, 0, 0};
  fill_misses(6, std::vector<double>{0.0}, std::vector<std::uint8_t>{0, 0, 0, 1, 0, 0}, radii);
  for (const double radius : radii) EXPECT_DOUBLE_EQ(radius, 7.0);
}

TEST(FillMisses, EmptySectionsComeFromTheirNeighbours) {
  const std::vector<double> arcs{0.0, 1.0, 2.0, 5.0, 6.0};
  std::vector<std::uint8_t> hits(5 * 2, 0);
  std::vector<double> radii(5 * 2, 0.0);
  const auto set = [&](std::size_t k, double a, double b) {
    hits[2 * k] = hits[2 * k + 1] = 1;
    radii[2 * k] = a;
    radii[2 * k + 1] = b;
  };
  set(1, 1.0, 10.0);
  set(3, 5.0, 50.0);
  fill_misses(2, arcs, hits, radii);
  EXPECT_EQ(radii, (std::vector<double>{1, 10, 1, 10, 2, 20, 5, 50, 5, 50}));
}

}  // namespace
}  // namespace fascicle::muscle
