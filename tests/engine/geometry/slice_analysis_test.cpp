#include "engine/geometry/slice_analysis.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "tests/support/shapes.hpp"

namespace fascicle {
namespace {

SliceLoop loop_of(std::vector<glm::dvec2> points) {
  SliceLoop loop;
  loop.points = std::move(points);
  measure_loop(loop);
  return loop;
}

SliceLoop ellipse(double a, double b, int count = 720) {
  std::vector<glm::dvec2> points;
  for (int i = 0; i < count; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / count;
    points.emplace_back(a * std::cos(angle), b * std::sin(angle));
  }
  return loop_of(points);
}

// A C that opens to the right: a square of side 3 without the middle and the right of its middle third.
SliceLoop letter_c() {
  return loop_of({{0, 0}, {3, 0}, {3, 1}, {1, 1}, {1, 2}, {3, 2}, {3, 3}, {0, 3}});
}

SliceLoop reversed(SliceLoop loop) {
  std::ranges::reverse(loop.points);
  measure_loop(loop);
  return loop;
}

TEST(SliceShape, OfNothingIsZero) {
  for (const SliceLoop& loop : {SliceLoop{}, loop_of({{1, 1}}), loop_of({{0, 0}, {1, 0}, {2, 0}}),
                                loop_of({{0, 0}, {0, 0}, {0, 0}})}) {
    const SliceShape shape = measure_shape(loop);
    EXPECT_EQ(shape.quotient, 0.0);
    EXPECT_EQ(shape.normalised_perimeter, 0.0);
    EXPECT_FALSE(shape.convex);
    EXPECT_TRUE(normalise_outline(loop).empty());
  }
}

TEST(SliceShape, ACircleIsTheBound) {
  const SliceShape shape = measure_shape(ellipse(0.02, 0.02));
  EXPECT_NEAR(shape.quotient, 1.0, 1e-4);
  EXPECT_LE(shape.quotient, 1.0);
  EXPECT_NEAR(shape.normalised_perimeter, 2.0 * std::sqrt(std::numbers::pi), 1e-4);
  EXPECT_NEAR(shape.dent, 0.0, 1e-9);
  EXPECT_TRUE(shape.convex);
  EXPECT_TRUE(shape.centroid_inside);
}

TEST(SliceShape, ASquareAndAnEllipse) {
  const SliceShape square = measure_shape(loop_of({{1, 1}, {3, 1}, {3, 3}, {1, 3}}));
  EXPECT_NEAR(square.quotient, std::numbers::pi / 4.0, 1e-12);
  EXPECT_NEAR(square.normalised_perimeter, 4.0, 1e-12);
  EXPECT_TRUE(square.convex);
  const SliceShape flat = measure_shape(ellipse(2.0, 1.0, 4000));
  EXPECT_NEAR(flat.quotient, 4.0 * std::numbers::pi * std::numbers::pi * 2.0 / (9.6884482205 * 9.6884482205), 1e-5);
  EXPECT_TRUE(flat.convex);
}

TEST(SliceShape, ALetterCIsConcaveAndItsCentroidOutside) {
  const SliceShape shape = measure_shape(letter_c());
  EXPECT_NEAR(shape.quotient, 4.0 * std::numbers::pi * 7.0 / (16.0 * 16.0), 1e-12);
  EXPECT_NEAR(shape.dent, 1.0 / std::sqrt(7.0), 1e-12);  // at the mouth's inner corners: 1 above the hull's foot
  EXPECT_FALSE(shape.convex);
  EXPECT_FALSE(shape.centroid_inside);  // at 18.5 / 14 from the left, half-way up
}

TEST(SliceShape, TurningTheOtherWayChangesNothing) {
  for (const SliceLoop& loop : {ellipse(2, 1), letter_c()}) {
    const SliceShape one = measure_shape(loop), other = measure_shape(reversed(loop));
    EXPECT_NEAR(one.quotient, other.quotient, 1e-12);
    EXPECT_NEAR(one.dent, other.dent, 1e-12);
    EXPECT_EQ(one.convex, other.convex);
    EXPECT_EQ(one.centroid_inside, other.centroid_inside);
  }
}

TEST(SliceShape, ShallowDentsAreNone) {
  // A unit square whose sides have points in them, off by what floats are off by; two points all but in one.
  const SliceShape shape = measure_shape(loop_of({{0, 0}, {0.5, 3e-8}, {1, 0}, {1, 1e-9}, {1, 1}, {0.4, 1}, {0, 1}}));
  EXPECT_TRUE(shape.convex);
  const auto dented = [](double depth) {
    return measure_shape(loop_of({{0, 0}, {0.5, depth}, {1, 0}, {1, 1}, {0, 1}}));
  };
  EXPECT_NEAR(dented(0.03).dent, 0.03 / std::sqrt(0.985), 1e-12);
  EXPECT_FALSE(dented(0.03).convex);
  EXPECT_FALSE(dented(0.0101).convex);
  EXPECT_TRUE(dented(0.0098).convex);
}

TEST(SliceShape, AChainCountsAsClosed) {
  SliceLoop chain = loop_of({{0, 0}, {2, 0}, {2, 2}, {0, 2}});
  chain.closed = false;
  measure_loop(chain);
  EXPECT_NEAR(chain.perimeter, 6.0, 1e-12);
  EXPECT_NEAR(measure_shape(chain).quotient, std::numbers::pi / 4.0, 1e-12);
}

TEST(NormaliseOutline, AreaOneCentredAndLyingDown) {
  std::vector<glm::dvec2> turned;
  for (const glm::dvec2& p : ellipse(3.0, 1.0).points) {
    turned.emplace_back(7.0 + 0.6 * p.x - 0.8 * p.y, -2.0 + 0.8 * p.x + 0.6 * p.y);
  }
  for (const SliceLoop& loop : {loop_of(turned), reversed(loop_of(turned))}) {
    const SliceLoop normal = loop_of(normalise_outline(loop));
    EXPECT_NEAR(normal.area, 1.0, 1e-9);
    EXPECT_NEAR(glm::length(normal.centroid), 0.0, 1e-9);
    double most_x = 0.0, most_y = 0.0;
    for (const glm::dvec2& p : normal.points) {
      most_x = std::max(most_x, std::abs(p.x));
      most_y = std::max(most_y, std::abs(p.y));
    }
    EXPECT_NEAR(most_x / most_y, 3.0, 1e-3);
  }
}

TEST(PlaceStations, LinesWithoutLengthHaveNone) {
  const std::array<double, 1> half = {0.5};
  EXPECT_TRUE(place_stations(std::span<const glm::dvec3>(), half).empty());
  const std::array<glm::dvec3, 1> point = {glm::dvec3(1, 2, 3)};
  EXPECT_TRUE(place_stations(point, half).empty());
  const std::array<glm::dvec3, 2> same = {glm::dvec3(1, 2, 3), glm::dvec3(1, 2, 3)};
  EXPECT_TRUE(place_stations(same, half).empty());
  const std::array<glm::dvec3, 2> wrong = {glm::dvec3(0.0), glm::dvec3(std::numeric_limits<double>::quiet_NaN())};
  EXPECT_TRUE(place_stations(wrong, half).empty());
  EXPECT_TRUE(place_stations(TriangleMesh{}, half).empty());
}

TEST(PlaceStations, AtFractionsOfTheLengthSquareToTheLine) {
  const std::array<glm::dvec3, 4> line = {glm::dvec3(0, 0, 0), {0, 0, 3}, {0, 0, 3}, {0, 1, 3}};
  const std::array<double, 3> fractions = {0.25, 0.75, 0.9};
  const auto stations = place_stations(line, fractions);
  ASSERT_EQ(stations.size(), 3u);
  const auto normal = [&](std::size_t i) { return glm::cross(stations[i].plane.u, stations[i].plane.v); };
  EXPECT_NEAR(glm::distance(stations[0].plane.origin, {0, 0, 1}), 0.0, 1e-12);
  EXPECT_NEAR(glm::distance(normal(0), {0, 0, 1}), 0.0, 1e-12);
  EXPECT_NEAR(glm::distance(stations[1].plane.origin, {0, 0, 3}), 0.0, 1e-12);
  EXPECT_NEAR(glm::distance(normal(1), glm::normalize(glm::dvec3(0, 1, 1))), 0.0, 1e-9);  // half-way round the bend
  EXPECT_NEAR(glm::distance(normal(2), {0, 1, 0}), 0.0, 1e-12);
}

TEST(SliceAt, ABoxAndATorus) {
  TriangleMesh box = test::make_box({0, 0, 0}, {1, 2, 6});
  box.name = "box";
  const std::array<double, 3> quarters = {0.25, 0.5, 0.75};
  auto slices = slice_at(box, place_stations(box, quarters));
  ASSERT_EQ(slices.size(), 3u);
  for (const MeshSlice& slice : slices) {
    EXPECT_EQ(slice.mesh, "box");
    ASSERT_EQ(slice.loops.size(), 1u);
    EXPECT_NEAR(slice.loops[0].loop.area, 2.0, 1e-6);
    EXPECT_TRUE(slice.loops[0].shape.convex);
  }
  const SliceSummary summary = summarise_slices(slices);
  EXPECT_EQ(summary.slices, 3u);
  EXPECT_EQ(summary.missed, 0u);
  EXPECT_NEAR(summary.mean_quotient, 4.0 * std::numbers::pi * 2.0 / 36.0, 1e-6);
  EXPECT_EQ(summary.share_round, 1.0);
  EXPECT_EQ(summary.share_concave, 0.0);
  EXPECT_EQ(summary.share_several, 0.0);

  const SlicePlane high{{0, 0, 9}, {1, 0, 0}, {0, 1, 0}};
  const std::array<SliceStation, 2> flat = {SliceStation{0.5, {}}, SliceStation{0.9, high}};
  slices = slice_at(test::make_torus(2.0f, 0.5f, 100, 50), flat);
  ASSERT_EQ(slices[0].loops.size(), 2u);
  EXPECT_GT(slices[0].loops[0].loop.area, 0.0);
  EXPECT_LT(slices[0].loops[1].loop.area, 0.0);
  EXPECT_TRUE(slices[1].loops.empty());
  const SliceSummary of_torus = summarise_slices(slices);
  EXPECT_EQ(of_torus.slices, 1u);
  EXPECT_EQ(of_torus.missed, 1u);
  EXPECT_EQ(of_torus.share_several, 1.0);
}

TEST(SummariseSlices, Shares) {
  std::vector<MeshSlice> slices;
  for (const SliceLoop& loop : {ellipse(1, 1), ellipse(8, 1), letter_c(), loop_of({{0, 0}, {1, 0}, {1, 1}, {0, 1}})}) {
    slices.push_back({"shape", 0.5, {{loop, measure_shape(loop)}}});
  }
  slices.push_back({"missed", 0.5, {}});
  const SliceSummary summary = summarise_slices(slices);
  EXPECT_EQ(summary.slices, 4u);
  EXPECT_EQ(summary.missed, 1u);
  EXPECT_EQ(summary.share_round, 0.5);
  EXPECT_EQ(summary.share_concave, 0.25);
  EXPECT_EQ(summary.share_centroid_outside, 0.25);
  EXPECT_NEAR(summary.median_quotient,
              0.5 * (slices[2].loops[0].shape.quotient + slices[3].loops[0].shape.quotient), 1e-12);
  EXPECT_EQ(summarise_slices({}).slices, 0u);
}

}  // namespace
}  // namespace fascicle
