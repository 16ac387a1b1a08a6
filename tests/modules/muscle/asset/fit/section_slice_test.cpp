// Slices in several loops: which is which, what is inside, where it is deepest, and which chain continues best.
#include "modules/muscle/asset/fit/section_slice.hpp"

#include <cmath>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "tests/modules/muscle/asset/fit/fit_shapes.hpp"
#include "tests/support/shapes.hpp"

namespace fascicle::muscle {
namespace {

using test::ellipse;
using test::make_tube;

// Across x, at x = 0.1: u is y and v is z.
const SectionFrame kAcross{{0.1, 0.0, 0.0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};

TriangleMesh tube(double y, double radius) {
  return make_tube([=](double) { return ellipse({y, 0.0}, radius, radius, 64); }, 0.3, 4);
}

TEST(SectionSlice, AMeshElsewhereGivesNone) {
  EXPECT_TRUE(slice_section(TriangleMesh{}, kAcross).empty());
  SectionFrame away = kAcross;
  away.centre.x = 5.0;
  EXPECT_TRUE(slice_section(tube(0.0, 0.02), away).empty());
}

TEST(SectionSlice, SeparatePartsAreSeparateSlices) {
  const std::vector<SectionSlice> slices = slice_section(test::join(tube(0.0, 0.01), tube(0.06, 0.02)), kAcross);
  ASSERT_EQ(slices.size(), 2u);
  EXPECT_NEAR(slices[0].centroid.x, 0.06, 1e-6);  // the greater one first
  EXPECT_NEAR(slices[1].centroid.x, 0.0, 1e-6);
  EXPECT_TRUE(slices[0].contains({0.06, 0.0}));
  EXPECT_FALSE(slices[0].contains({0.0, 0.0}));
  EXPECT_NEAR(slices[0].distance({0.0, 0.0}), 0.04, 1e-4);
}

TEST(SectionSlice, OverlappingShellsAreOne) {
  const TriangleMesh mesh = test::join(test::join(tube(0.0, 0.01), tube(0.015, 0.01)), tube(0.03, 0.01));
  const std::vector<SectionSlice> slices = slice_section(mesh, kAcross);
  ASSERT_EQ(slices.size(), 1u);
  std::vector<InsideInterval> inside;
  find_inside(slices[0], {1.0, 0.0}, inside);
  ASSERT_EQ(inside.size(), 1u);
  EXPECT_NEAR(inside[0].from, -0.01, 1e-4);
  EXPECT_NEAR(inside[0].to, 0.04, 1e-4);
}

TEST(SectionSlice, HolesAreOutside) {
  const TriangleMesh mesh = test::join(tube(0.0, 0.03), test::inside_out(tube(0.005, 0.01)));
  const std::vector<SectionSlice> slices = slice_section(mesh, kAcross);
  ASSERT_EQ(slices.size(), 1u);
  EXPECT_FALSE(slices[0].contains({0.005, 0.0}));
  EXPECT_TRUE(slices[0].contains({-0.02, 0.0}));
  std::vector<InsideInterval> inside;
  find_inside(slices[0], {0.0, 1.0}, inside);
  ASSERT_EQ(inside.size(), 2u);
  EXPECT_NEAR(inside[0].from, -0.03, 1e-4);
  EXPECT_NEAR(inside[0].to, -std::sqrt(0.0001 - 0.000025), 1e-4);
  const glm::dvec2 deepest = deepest_point(slices[0]);
  EXPECT_TRUE(slices[0].contains(deepest));
  EXPECT_GT(slices[0].distance(deepest), 0.0122);  // the ring is 25 mm wide on one side
}

TEST(SectionSlice, LinesThroughCornersCountThemOnce) {
  SectionSlice square = slice_of({{-1, -1}, {1, -1}, {1, 1}, {-1, 1}});
  std::vector<InsideInterval> inside;
  const double diagonal = std::sqrt(0.5);
  for (const glm::dvec2& direction : {glm::dvec2(diagonal, diagonal), glm::dvec2(-diagonal, diagonal)}) {
    find_inside(square, direction, inside);
    ASSERT_EQ(inside.size(), 1u);
    EXPECT_NEAR(inside[0].from, -std::sqrt(2.0), 1e-12);
    EXPECT_NEAR(inside[0].to, std::sqrt(2.0), 1e-12);
  }
}

TEST(SectionSlice, DeepestPoints) {
  const glm::dvec2 square = deepest_point(slice_of({{0, 0}, {2, 0}, {2, 2}, {0, 2}}));
  EXPECT_NEAR(square.x, 1.0, 0.02);
  EXPECT_NEAR(square.y, 1.0, 0.02);
  const SectionSlice c = slice_of(test::c_shape({0, 0}, 0.03, 0.004, 0.9));
  EXPECT_GT(c.distance(deepest_point(c)), 0.0036);
  EXPECT_TRUE(c.contains(deepest_point(c)));
  // Thinner than the grid's step, and bent.
  const SectionSlice thin = slice_of(test::c_shape({0, 0}, 0.03, 0.00002, 0.3));
  EXPECT_TRUE(thin.contains(deepest_point(thin)));
}

TEST(ChooseSlices, TheChainThatContinuesWins) {
  std::vector<SectionFrame> frames;
  std::vector<std::vector<SectionSlice>> candidates;
  for (int k = 0; k < 6; ++k) {
    frames.push_back({{0.02 * k, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}});
    std::vector<SectionSlice> here;
    here.push_back(slice_of(ellipse({0.05, 0}, 0.02, 0.02)));          // greater, but away from the line
    here.push_back(slice_of(ellipse({0.001 * k, 0}, 0.008, 0.008)));
    if (k == 3) std::swap(here[0], here[1]);
    if (k == 4) here.clear();
    candidates.push_back(std::move(here));
  }
  EXPECT_EQ(choose_slices(frames, candidates), (std::vector<int>{1, 1, 1, 0, -1, 1}));
}

TEST(ChooseSlices, NothingToChooseFrom) {
  EXPECT_TRUE(choose_slices({}, {}).empty());
  const std::vector<SectionFrame> frames{kAcross, kAcross};
  EXPECT_EQ(choose_slices(frames, std::vector<std::vector<SectionSlice>>(2)), (std::vector<int>{-1, -1}));
}

}  // namespace
}  // namespace fascicle::muscle
