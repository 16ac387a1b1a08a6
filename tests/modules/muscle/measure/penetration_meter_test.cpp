#include "modules/muscle/measure/penetration_meter.hpp"

#include <algorithm>
#include <limits>

#include <gtest/gtest.h>
#include <glm/gtc/matrix_transform.hpp>

#include "tests/modules/muscle/measure/measured_shapes.hpp"

namespace fascicle::muscle {
namespace {

using test::bone_of;
using test::cylinder;
using test::Measured;

constexpr float kTolerance = 1.5e-4f;  // m: the cylinders have 64 sides, the points are 3 mm apart

TEST(PenetrationMeter, NothingTouchesNothing) {
  const Measured apart({cylinder("a", {0, 0, 0}, {0, 0.2f, 0}, 0.01f),
                        cylinder("b", {0.03f, 0, 0}, {0.03f, 0.2f, 0}, 0.01f)},
                       {bone_of(test::make_sphere(0.02f, 16, 32, {0, 0.1f, 0.05f}))});
  const Penetration found = apart.at_rest();
  EXPECT_TRUE(found.bones.empty());
  EXPECT_TRUE(found.muscles.empty());
  EXPECT_GT(found.points, 1000u);
  EXPECT_EQ(found.left_out, 0u);
}

TEST(PenetrationMeter, SurfacesThatAreNotFiniteAndCollapsedOnesAreLeftOut) {
  const Measured pair({cylinder("a", {0, 0, 0}, {0, 0.2f, 0}, 0.02f),
                       cylinder("b", {0.03f, 0, 0}, {0.03f, 0.2f, 0}, 0.02f),
                       cylinder("c", {0.06f, 0, 0}, {0.06f, 0.2f, 0}, 0.02f)},
                      {});
  const std::vector<glm::mat4> bones{glm::mat4(1.0f)};
  RestSurfaces rest = make_rest_surfaces(pair.asset, bones);
  PenetrationMeter meter(pair.asset, make_bone_solids({}));
  EXPECT_EQ(meter.measure(rest.surfaces, rest.tendons, bones).muscles.size(), 2u);
  rest.surfaces.vertices[pair.asset->muscles[0].first_vertex + 5].position.y = std::numeric_limits<float>::quiet_NaN();
  const Penetration without = meter.measure(rest.surfaces, rest.tendons, bones);
  EXPECT_EQ(without.left_out, 1u);
  ASSERT_EQ(without.muscles.size(), 1u);
  EXPECT_EQ(without.muscles[0].muscle + without.muscles[0].other, 3u);
  const MuscleLayout& last = pair.asset->muscles[2];
  for (std::uint32_t v = 0; v < last.vertex_count; ++v) {
    rest.surfaces.vertices[last.first_vertex + v].position = glm::vec3(0.03f, 0.1f, 0.0f);
  }
  const Penetration alone = meter.measure(rest.surfaces, rest.tendons, bones);
  EXPECT_EQ(alone.left_out, 2u);
  EXPECT_TRUE(alone.muscles.empty());
}

// Two cylinders side by side: the overlap of their radii, for the short one's surface is in the middle of the long one.
TEST(PenetrationMeter, ParallelCylindersAreAsDeepAsTheirRadiiOverlap) {
  for (const float distance : {0.049f, 0.045f, 0.030f}) {
    const Measured pair({cylinder("long", {0, -0.2f, 0}, {0, 0.4f, 0}, 0.025f),
                         cylinder("short", {distance, 0, 0}, {distance, 0.2f, 0}, 0.025f)},
                        {});
    const Penetration found = pair.at_rest();
    ASSERT_EQ(found.muscles.size(), 1u);
    EXPECT_NEAR(found.muscles[0].depth, 0.05f - distance, kTolerance);
    EXPECT_TRUE(found.bones.empty());
  }
}

// The other's caps close it: what is beyond them is outside.
TEST(PenetrationMeter, TheOthersEndsAreClosed) {
  const Measured pair({cylinder("measured", {0, 0, 0}, {0, 0.2f, 0}, 0.004f),
                       cylinder("short", {0, 0.09f, 0}, {0, 0.11f, 0}, 0.05f)},
                      {});
  const Penetration found = pair.at_rest();
  ASSERT_EQ(found.muscles.size(), 1u);
  EXPECT_EQ(found.muscles[0].muscle, 0u);
  // 10 mm from either cap in the middle, where there is a point within half the spacing.
  EXPECT_LE(found.muscles[0].depth, 0.01f + 1e-6f);
  EXPECT_GE(found.muscles[0].depth, 0.01f - 0.5f * kSampleSpacing);
  EXPECT_NEAR(found.muscles[0].place, 4.0f, 0.1f);
}

// A thin muscle along the diameter of a sphere: deepest on the middle, one muscle's radius from the centre.
TEST(PenetrationMeter, ACylinderThroughASphereIsAsDeepAsItsSurfaceIsNearTheCentre) {
  const glm::mat4 half_way = glm::translate(glm::mat4(1.0f), {0, 0.1f, 0});
  const Measured through({cylinder("a", {0, 0, 0}, {0, 0.2f, 0}, 0.01f)},
                         {bone_of(test::make_sphere(0.03f, 64, 128), 0, half_way)});
  const Penetration found = through.at_rest();
  ASSERT_EQ(found.bones.size(), 1u);
  EXPECT_NEAR(found.bones[0].depth, 0.02f, kTolerance);
  EXPECT_EQ(found.bones[0].bone, 0);
  EXPECT_NEAR(found.bones[0].position.y, 0.1f, 0.5f * kSampleSpacing);
  EXPECT_NEAR(found.bones[0].place, 4.0f, 0.1f);
  EXPECT_TRUE(found.muscles.empty());
}

TEST(PenetrationMeter, BonesAreMeasuredWhereTheyAre) {
  const Measured pair({cylinder("a", {0, 0, 0}, {0, 0.2f, 0}, 0.02f)},
                      {bone_of(test::make_box({0.0f, -0.5f, -0.5f}, {0.5f, 0.5f, 0.5f}), 1)}, 2);
  std::vector<glm::mat4> pose{glm::mat4(1.0f), glm::translate(glm::mat4(1.0f), {0.015f, 0, 0})};
  ASSERT_EQ(pair.at(pose).bones.size(), 1u);
  EXPECT_NEAR(pair.at(pose).bones[0].depth, 0.005f, kTolerance);
  pose[1] = glm::rotate(glm::translate(glm::mat4(1.0f), {-0.017f, 0.1f, 0}), 3.14159265f, {0, 0, 1});
  ASSERT_EQ(pair.at(pose).bones.size(), 1u);
  EXPECT_NEAR(pair.at(pose).bones[0].depth, 0.003f, kTolerance);
  // All together may turn and move without a difference.
  const glm::mat4 away =
      glm::rotate(glm::translate(glm::mat4(1.0f), {3.0f, -2.0f, 1.0f}), 1.0f, glm::vec3(0.6f, 0.0f, 0.8f));
  for (glm::mat4& bone : pose) bone = away * bone;
  ASSERT_EQ(pair.at(pose).bones.size(), 1u);
  EXPECT_NEAR(pair.at(pose).bones[0].depth, 0.003f, kTolerance);
}

// Four segments of 50 mm: points up to 25 mm from the origin's section are nearer to it than to the next.
TEST(PenetrationMeter, TheFirstAndTheLastSectionAreLeftOut) {
  const std::vector<MuscleDescription> muscles{cylinder("a", {0, 0, 0}, {0, 0.2f, 0}, 0.01f, 2)};
  for (const bool insertion : {false, true}) {
    const auto deepest_with = [&](float reach) {
      const glm::vec3 lower = insertion ? glm::vec3(-0.3f, 0.2f - reach, -0.3f) : glm::vec3(-0.3f, -0.3f, -0.3f);
      const glm::vec3 upper = insertion ? glm::vec3(0.3f, 0.5f, 0.3f) : glm::vec3(0.3f, reach, 0.3f);
      return deepest(Measured(muscles, {bone_of(test::make_box(lower, upper))}).at_rest().bones).depth;
    };
    EXPECT_EQ(deepest_with(0.0249f), 0.0f) << insertion;
    // 50 mm in 17 steps: the first point that counts is 26.47 mm along.
    EXPECT_NEAR(deepest_with(0.03f), 0.03f - 0.02647f, kTolerance) << insertion;
    EXPECT_NEAR(deepest_with(0.06f), 0.06f - 0.02647f, kTolerance) << insertion;
  }
}

// Points 3 mm apart find a thorn that lies between a coarse muscle's vertices.
TEST(PenetrationMeter, PointsLieBetweenTheVerticesToo) {
  const Measured pricked({cylinder("a", {0, 0, 0}, {0, 0.2f, 0}, 0.03f, 1, 6)},
                         {bone_of(test::make_box({0.02f, 0.11f, -0.004f}, {0.05f, 0.118f, 0.004f}))});
  EXPECT_TRUE(pricked.at_rest(1.0f).bones.empty());
  EXPECT_GT(deepest(pricked.at_rest().bones).depth, 0.002f);
}

TEST(PenetrationMeter, APairIsListedOnceAndInOrder) {
  std::vector<MuscleDescription> muscles;
  for (int i = 0; i < 4; ++i) {
    const float x = 0.03f * static_cast<float>(i);
    muscles.push_back(cylinder("m" + std::to_string(i), {x, 0, 0}, {x, 0.2f, 0}, 0.02f, 2, 16));
  }
  const Measured row(muscles, {bone_of(test::make_sphere(0.02f, 16, 32, {0.03f, 0.1f, 0})),
                               bone_of(test::make_sphere(0.01f, 16, 32, {0.03f, 0.12f, 0}))});
  const Penetration found = row.at_rest();
  ASSERT_EQ(found.muscles.size(), 3u);
  for (std::uint32_t i = 0; i < 3; ++i) {
    EXPECT_EQ(std::min(found.muscles[i].muscle, found.muscles[i].other), i);
    EXPECT_EQ(std::max(found.muscles[i].muscle, found.muscles[i].other), i + 1);
    EXPECT_EQ(found.muscles[i].bone, -1);
  }
  // Of a bone's two meshes the deeper counts.
  ASSERT_EQ(found.bones.size(), 3u);
  EXPECT_EQ(found.bones[0].muscle, 0u);
  EXPECT_EQ(found.bones[2].muscle, 2u);
}

}  // namespace
}  // namespace fascicle::muscle
