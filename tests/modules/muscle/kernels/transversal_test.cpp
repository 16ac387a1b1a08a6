#include "modules/muscle/kernels/transversal.hpp"

#include <cmath>
#include <limits>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

namespace fascicle::muscle {
namespace {

// A round section with the tag that looks at `towards`.
TransversalEnd circle(const glm::vec3& centre, float radius, const glm::vec3& towards) {
  return {.tag = centre + radius * towards, .centre = centre};
}
constexpr glm::vec3 kRight{1.0f, 0.0f, 0.0f}, kLeft{-1.0f, 0.0f, 0.0f}, kUp{0.0f, 1.0f, 0.0f};

// Radii 2 cm and 1 cm, tags facing each other, centres this far apart along x and y.
TransversalDepth facing(float apart, float beside = 0.0f) {
  return measure_transversal(circle({}, 0.02f, kRight), circle({apart, beside, 0.0f}, 0.01f, kLeft));
}

TEST(Transversal, ApartNothingTouches) {
  const TransversalDepth depth = facing(0.05f);
  EXPECT_FALSE(depth.touches);
  EXPECT_EQ(depth.thesis, 0.0f);
  EXPECT_EQ(depth.overlap, 0.0f);
  EXPECT_FLOAT_EQ(depth.x.radius, 0.02f);
  EXPECT_FLOAT_EQ(depth.y.radius, 0.01f);
}

TEST(Transversal, TheMeanOfFacingTagsIsTheOverlap) {
  for (const float overlap : {0.001f, 0.005f, 0.009f}) {
    const TransversalDepth depth = facing(0.03f - overlap);
    EXPECT_TRUE(depth.x.acute && depth.y.acute);
    EXPECT_NEAR(depth.x.depth, overlap, 1e-8f);
    EXPECT_NEAR(depth.y.depth, overlap, 1e-8f);
    EXPECT_NEAR(depth.thesis, 2.0f * overlap, 1e-8f);
    EXPECT_NEAR(depth.overlap, overlap, 1e-8f);
  }
}

TEST(Transversal, SwappedSidesAreDeeperThanARadius) {
  const TransversalDepth depth = facing(-0.03f);
  EXPECT_NEAR(depth.overlap, 0.06f, 1e-7f);
  EXPECT_GT(depth.overlap, depth.x.radius);
  EXPECT_GT(depth.thesis, depth.overlap);
}

TEST(Transversal, OneAcuteAngle) {
  // y's tag is inside x's side, but looks up, and x's tag is above it.
  const TransversalEnd x = circle({}, 0.02f, kRight);
  const TransversalEnd y = circle({0.015f, -0.015f, 0.0f}, 0.01f, kUp);
  const TransversalDepth depth = measure_transversal(x, y);
  EXPECT_TRUE(depth.x.acute);
  EXPECT_FALSE(depth.y.acute);
  EXPECT_NEAR(depth.thesis, 0.005f, 1e-8f);
  EXPECT_NEAR(depth.overlap, 0.0025f, 1e-8f);
}

TEST(Transversal, BesideEachOtherIsNoOverlapForOurs) {
  // Past the smaller radius to the side, the half-spaces still overlap, the sections do not.
  const TransversalDepth near = facing(0.025f, 0.009f), far = facing(0.025f, 0.011f);
  EXPECT_NEAR(near.x.lateral, 0.009f, 1e-8f);
  EXPECT_NEAR(near.overlap, 0.005f, 1e-8f);
  EXPECT_EQ(far.overlap, 0.0f);
  EXPECT_NEAR(far.thesis, 0.01f, 1e-8f);
}

TEST(Transversal, ExchangingTheEndsExchangesTheAnswers) {
  const TransversalEnd x{.tag = {0.01f, 0.002f, 0.003f}, .centre = {-0.01f, 0.001f, 0.0f}};
  const TransversalEnd y{.tag = {0.006f, -0.001f, 0.001f}, .centre = {0.02f, 0.004f, -0.002f}};
  const TransversalDepth there = measure_transversal(x, y), back = measure_transversal(y, x);
  EXPECT_TRUE(there.touches);
  EXPECT_EQ(there.x.depth, back.y.depth);
  EXPECT_EQ(there.y.depth, back.x.depth);
  EXPECT_EQ(there.thesis, back.thesis);
  EXPECT_EQ(there.overlap, back.overlap);
}

TEST(Transversal, APointOfABoneHasNoAngle) {
  const glm::vec3 point(0.015f, 0.0f, 0.0f);
  const TransversalDepth depth = measure_transversal(circle({}, 0.02f, kRight), {.tag = point, .centre = point});
  EXPECT_TRUE(depth.x.acute);
  EXPECT_FALSE(depth.y.acute);
  EXPECT_NEAR(depth.thesis, 0.005f, 1e-8f);
  EXPECT_NEAR(depth.overlap, 0.005f, 1e-8f);
}

TEST(Transversal, WithoutARadiusThereIsNoDirection) {
  const TransversalEnd nothing{};
  const TransversalDepth depth = measure_transversal(nothing, nothing);
  EXPECT_FALSE(depth.touches);
  EXPECT_EQ(depth.overlap, 0.0f);
  EXPECT_EQ(transversal_displacement(depth.x, 1.0f), glm::vec3(0.0f));
}

TEST(Transversal, NotFiniteNeverTouches) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  TransversalEnd x = circle({}, 0.02f, kRight), y = circle({0.025f, 0.0f, 0.0f}, 0.01f, kLeft);
  y.tag.x = nan;
  EXPECT_FALSE(measure_transversal(x, y).touches);
  x.centre.y = nan;
  EXPECT_FALSE(measure_transversal(x, y).touches);
}

TEST(TransversalDisplacement, PutsTheCentreAtTheDepthFromItsTag) {
  const TransversalEnd x = circle({}, 0.02f, kRight);
  const TransversalDepth depth = measure_transversal(x, circle({-0.03f, 0.0f, 0.0f}, 0.01f, kLeft));
  ASSERT_GT(depth.thesis, 0.02f);
  const glm::vec3 centre = x.centre + transversal_displacement(depth.x, depth.thesis);
  EXPECT_NEAR(glm::length(centre - x.tag), depth.thesis, 1e-7f);
  EXPECT_LT(centre.x, -0.02f);  // away from its own tag, past the other muscle
  EXPECT_EQ(centre.y, 0.0f);
}

TEST(TransversalDisplacement, UpToTheRadiusNothingMoves) {
  const TransversalDepth depth = facing(0.025f);
  EXPECT_EQ(transversal_displacement(depth.x, depth.x.radius), glm::vec3(0.0f));
  EXPECT_EQ(transversal_displacement(depth.x, depth.thesis), glm::vec3(0.0f));
  EXPECT_EQ(transversal_displacement(depth.x, std::numeric_limits<float>::infinity()), glm::vec3(0.0f));
}

}  // namespace
}  // namespace fascicle::muscle
