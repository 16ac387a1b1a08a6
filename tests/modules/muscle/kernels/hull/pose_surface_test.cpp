// Poses of a spindle: rest and rigid motions exactly, volume, attachments, bones, no history, the full mesh's answer.
#include "modules/muscle/kernels/hull/pose_surface.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <gtest/gtest.h>

#include "modules/muscle/asset/hull/pose_reference.hpp"
#include "modules/muscle/kernels/hull/mesh_volume.hpp"
#include "tests/modules/muscle/kernels/hull/posed_spindle.hpp"
#include "tests/support/analytic_bones.hpp"

namespace fascicle::muscle {
namespace {

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

double volume_of(const PosedSpindle& spindle) {
  return measure_volume(spindle.asset->triangles, std::span(spindle.points).first(spindle.asset->vertex_count), {});
}

float furthest_from(const PosedSpindle& spindle, const AlignedVector<SurfacePoint>& other) {
  float most = 0.0f;
  for (std::uint32_t v = 0; v < spindle.asset->vertex_count; ++v) {
    most = std::max(most, glm::distance(spindle.point(v), glm::vec3(other[v].x, other[v].y, other[v].z)));
  }
  return most;
}

bool is_finite(const PosedSpindle& spindle) {
  return std::ranges::all_of(spindle.points, [](const SurfacePoint& p) { return std::isfinite(p.x + p.y + p.z); });
}

TEST(PoseSurface, BonesThatAreNoNumbersEndTheIterations) {
  PosedSpindle spindle;
  spindle.move(glm::mat4(1.0f), glm::mat4(kNaN));
  const HullPose pose = spindle.pose();
  EXPECT_FALSE(pose.converged);
  EXPECT_LE(pose.iterations, spindle.settings.iterations);
  // The next sound pose knows nothing of it.
  spindle.move(glm::mat4(1.0f), bent(0.5f));
  EXPECT_TRUE(spindle.pose().converged);
  PosedSpindle fresh;
  fresh.move(glm::mat4(1.0f), bent(0.5f));
  fresh.pose();
  EXPECT_EQ(furthest_from(spindle, fresh.points), 0.0f);
}

TEST(PoseSurface, ALineThatIsNoNumberOrHasNoLengthLeavesTheShapeToTheRest) {
  PosedSpindle spindle;
  for (const float place : {0.0f, kNaN}) {
    spindle.line.assign(spindle.line.size(), glm::vec3(place));
    spindle.pose();
    EXPECT_TRUE(is_finite(spindle)) << place;
  }
  spindle.line.clear();
  spindle.pose();
  EXPECT_TRUE(is_finite(spindle));
}

TEST(PoseSurface, RestIsRestToTheBit) {
  for (const SimdLevel level : {SimdLevel::kPortable, detect_simd()}) {
    PosedSpindle spindle;
    spindle.simd = level;
    const HullPose pose = spindle.pose();
    EXPECT_TRUE(pose.converged);
    EXPECT_EQ(pose.iterations, 1u);
    EXPECT_EQ(furthest_from(spindle, spindle.asset->rest), 0.0f);
  }
}

TEST(PoseSurface, WhatMovesAllBonesMovesTheMuscle) {
  PosedSpindle spindle;
  const glm::mat4 motion = glm::rotate(glm::translate(glm::mat4(1.0f), glm::vec3(0.1f, -0.2f, 0.3f)), 2.0f,
                                       glm::normalize(glm::vec3(1.0f, 2.0f, -0.5f)));
  spindle.move(motion, motion);
  EXPECT_TRUE(spindle.pose().converged);
  for (std::uint32_t v = 0; v < spindle.asset->vertex_count; ++v) {
    EXPECT_LT(glm::distance(spindle.point(v), glm::vec3(motion * glm::vec4(spindle.rest(v), 1.0f))), 2e-6f);
  }
}

TEST(PoseSurface, AttachedVerticesGoWithTheirBonesAndTheVolumeStays) {
  PosedSpindle spindle;
  for (const float angle : {-1.0f, -0.3f, 0.2f, 0.7f, 1.2f}) {
    const glm::mat4 upper = bent(angle);
    spindle.move(glm::mat4(1.0f), upper);
    for (const std::uint32_t refinements : {0u, 2u}) {
      spindle.settings.refinements = refinements;
      const HullPose pose = spindle.pose();
      EXPECT_TRUE(pose.converged) << angle;
      EXPECT_LE(pose.iterations, 10u);
      EXPECT_NEAR(volume_of(spindle), spindle.asset->volume, 2e-5 * spindle.asset->volume);
      EXPECT_NEAR(pose.volume, volume_of(spindle), 1e-6 * spindle.asset->volume);
      for (const AttachedVertex& attached : spindle.asset->attached) {
        const glm::mat4 motion = attached.attachment == 0 ? glm::mat4(1.0f) : upper;
        const glm::vec3 to(motion * glm::vec4(spindle.rest(attached.vertex), 1.0f));
        EXPECT_LT(glm::distance(spindle.point(attached.vertex), to), 1e-6f);
      }
    }
  }
}

TEST(PoseSurface, StretchedItIsThinnerAndPressedItIsThicker) {
  PosedSpindle spindle;
  const auto radius = [&] {
    double sum = 0.0, count = 0.0;
    for (std::uint32_t v = 0; v < spindle.asset->vertex_count; ++v) {
      if (std::abs(spindle.rest(v).z) > 0.01f) continue;
      sum += static_cast<double>(glm::length(glm::vec2(spindle.point(v))));
      count += 1.0;
    }
    return sum / count;
  };
  const double rest = radius();
  spindle.move(glm::mat4(1.0f), glm::translate(glm::mat4(1.0f), glm::vec3(0.0f, 0.0f, 0.2f * kSpindleLength)));
  EXPECT_TRUE(spindle.pose().converged);
  const double thin = radius();
  spindle.move(glm::mat4(1.0f), glm::translate(glm::mat4(1.0f), glm::vec3(0.0f, 0.0f, -0.2f * kSpindleLength)));
  EXPECT_TRUE(spindle.pose().converged);
  // Evenly stretched by 20 % it would be 9 % thinner; its held ends leave more to its middle.
  EXPECT_LT(thin, 0.95 * rest);
  EXPECT_GT(thin, 0.8 * rest);
  EXPECT_GT(radius(), 1.05 * rest);
}

TEST(PoseSurface, APoseIsTheSameWhateverCameBefore) {
  PosedSpindle spindle;
  spindle.move(glm::mat4(1.0f), bent(0.8f));
  spindle.pose();
  const AlignedVector<SurfacePoint> first = spindle.points;
  for (const float angle : {-1.3f, 0.1f, 3.0f, 0.8f}) {
    spindle.move(glm::mat4(1.0f), bent(angle));
    spindle.pose();
  }
  EXPECT_EQ(furthest_from(spindle, first), 0.0f);
}

TEST(PoseSurface, InstructionSetsGiveTheSameBits) {
  PosedSpindle plain, wide;
  plain.simd = SimdLevel::kPortable;
  for (PosedSpindle* spindle : {&plain, &wide}) {
    spindle->move(glm::mat4(1.0f), bent(0.9f));
    spindle->pose();
  }
  EXPECT_EQ(furthest_from(plain, wide.points), 0.0f);
  EXPECT_EQ(plain.scratch.residuals, wide.scratch.residuals);
}

TEST(PoseSurface, IterationsEndFasterThanTheyBegin) {
  PosedSpindle spindle;
  spindle.settings.tolerance = 1.0e-6f;
  spindle.move(glm::mat4(1.0f), bent(0.8f));
  ASSERT_TRUE(spindle.pose().converged);
  const std::vector<float>& moved = spindle.scratch.residuals;
  ASSERT_GE(moved.size(), 3u);
  // From the first that is below a hundredth on each takes off more than half.
  for (std::size_t i = 1; i < moved.size(); ++i) {
    if (moved[i - 1] > 0.01f || moved[i - 1] < 2.0e-6f) continue;
    EXPECT_LT(moved[i], 0.5f * moved[i - 1]) << i;
  }
}

TEST(PoseSurface, AbsurdPosesStayFinite) {
  PosedSpindle spindle;
  for (const glm::mat4& upper :
       {bent(std::numbers::pi_v<float>), glm::translate(glm::mat4(1.0f), glm::vec3(3.0f, 0.0f, 0.0f)),
        glm::translate(glm::mat4(1.0f), glm::vec3(0.0f, 0.0f, -kSpindleLength)),
        glm::translate(glm::mat4(1.0f), glm::vec3(0.0f, 0.0f, -3.0f * kSpindleLength)), glm::scale(glm::mat4(1.0f), glm::vec3(0.0f))}) {
    spindle.move(glm::mat4(1.0f), upper);
    spindle.pose();
    EXPECT_TRUE(is_finite(spindle));
  }
}

TEST(PoseSurface, StaysOutOfABoneThatPressesIntoIt) {
  const auto ball = test::sphere_bone(0.03f);
  PosedSpindle spindle(ball.get());
  const float distance = spindle.asset->settings.contact_distance;
  // At rest the ball is beside the spindle; it comes from the side, by as much as half of the spindle's radius.
  const glm::vec3 at_rest(kSpindleRadius + 0.04f, 0.0f, 0.0f);
  spindle.rest_to_bone[0] = glm::translate(glm::mat4(1.0f), -at_rest);
  for (const float depth : {0.0f, 0.004f, 0.008f, 0.015f}) {
    const glm::vec3 way(-0.01f - depth, 0.0f, 0.0f), middle = at_rest + way;
    spindle.bones[0].to = glm::translate(glm::mat4(1.0f), way);
    const HullPose pose = spindle.pose();
    EXPECT_TRUE(pose.converged) << depth;
    float nearest = 1.0f;
    std::uint32_t touching = 0;
    for (std::uint32_t v = 0; v < spindle.asset->vertex_count; ++v) {
      nearest = std::min(nearest, glm::distance(spindle.point(v), middle) - 0.03f);
      if (glm::distance(spindle.point(v), middle) < 0.03f + distance + 2e-4f) ++touching;
    }
    EXPECT_GT(nearest, distance - 2e-4f) << depth;
    EXPECT_NEAR(volume_of(spindle), spindle.asset->volume, 2e-4 * spindle.asset->volume);
    EXPECT_GT(touching, 0u) << depth;
    EXPECT_GT(spindle.scratch.touches[0].vertices, 0u) << depth;  // and it is told
    // Without the bone it would be inside: the solver is what keeps it out.
    SurfaceStep step = spindle.step();
    step.settings.collide_with_bones = false;
    pose_surface(step, *spindle.hull, hull_kernels(spindle.simd), spindle.settings, spindle.line, spindle.scratch);
    nearest = 1.0f;
    for (std::uint32_t v = 0; v < spindle.asset->vertex_count; ++v) {
      nearest = std::min(nearest, glm::distance(spindle.point(v), middle) - 0.03f);
    }
    EXPECT_NEAR(nearest, -depth, 1e-3f);
  }
}

TEST(PoseSurface, ConvergesWhereBonesPressIt) {
  const auto ball = test::sphere_bone(0.03f);
  PosedSpindle spindle(ball.get(), 150);
  spindle.settings.refinements = 0;
  spindle.rest_to_bone[0] = glm::translate(glm::mat4(1.0f), glm::vec3(-kSpindleRadius - 0.04f, 0.0f, 0.0f));
  int poses = 0, converged = 0;
  for (const float angle : {0.0f, 0.4f, 0.8f}) {
    for (const float shift : {-0.03f, 0.0f, 0.03f}) {
      for (const float depth : {-0.01f, 0.003f, 0.006f, 0.01f, 0.015f}) {
        spindle.move(glm::mat4(1.0f), glm::translate(glm::mat4(1.0f), glm::vec3(0.0f, 0.0f, shift)) * bent(angle));
        spindle.bones[0].to = glm::translate(glm::mat4(1.0f), glm::vec3(-0.01f - depth, 0.0f, 0.0f));
        ++poses;
        if (spindle.pose().converged) ++converged;
      }
    }
  }
  // One presses straight at the line, and which side it gives way to is decided late.
  EXPECT_GE(converged, poses - 1);
}

// One vertex that comes to touch a bone must not move the others.
TEST(PoseSurface, TouchingMoreOrLessIsNoJump) {
  const auto ball = test::sphere_bone(0.03f);
  PosedSpindle spindle(ball.get());
  spindle.rest_to_bone[0] = glm::translate(glm::mat4(1.0f), glm::vec3(-kSpindleRadius - 0.04f, 0.0f, 0.0f));
  AlignedVector<SurfacePoint> before;
  float most = 0.0f;
  for (int i = 0; i < 100; ++i) {
    spindle.bones[0].to = glm::translate(glm::mat4(1.0f), glm::vec3(-0.008f - 5.0e-5f * static_cast<float>(i), 0.0f, 0.0f));
    spindle.pose();
    if (!before.empty()) most = std::max(most, furthest_from(spindle, before));
    before = spindle.points;
  }
  EXPECT_LT(most, 3.0e-4f);  // the bone goes 0.05 mm a pose
}

TEST(PoseSurface, ABoneThatSwallowsItLeavesItFinite) {
  const auto ball = test::sphere_bone(0.2f, 0.01f);
  PosedSpindle spindle(ball.get());
  spindle.move(glm::mat4(1.0f), bent(0.4f));
  const HullPose pose = spindle.pose();
  EXPECT_TRUE(is_finite(spindle));
  EXPECT_TRUE(std::isfinite(pose.volume));
}

TEST(PoseSurface, AHullComesNearTheFullMeshsAnswer) {
  PosedSpindle spindle(nullptr, 150, 0.0f);  // the last iterations know no direction
  const PoseReference reference(*spindle.asset, *spindle.hull);
  for (const float angle : {0.3f, 0.8f}) {
    spindle.move(glm::mat4(1.0f), bent(angle));
    HullSettings settings = spindle.settings;
    settings.tolerance = 1.0e-6f;
    const HullPose full = reference.pose(spindle.step(), settings, spindle.line);
    ASSERT_TRUE(full.converged) << full.iterations;
    EXPECT_NEAR(full.volume, spindle.asset->volume, 1e-4 * spindle.asset->volume);
    const AlignedVector<SurfacePoint> truth = spindle.points;
    const double least = reference.energy(truth);
    ASSERT_TRUE(spindle.pose().converged);
    const double found = reference.energy(spindle.points);
    EXPECT_LT(furthest_from(spindle, truth), 0.02f * spindle.asset->size) << angle;
    EXPECT_LT(found, 1.15 * least) << angle;
    EXPECT_GT(found, 0.9 * least) << angle;
  }
}

}  // namespace
}  // namespace fascicle::muscle
