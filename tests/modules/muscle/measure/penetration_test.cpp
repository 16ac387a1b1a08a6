#include "modules/muscle/measure/penetration.hpp"

#include <gtest/gtest.h>

namespace fascicle::muscle {
namespace {

PairDepth in_bone(std::uint32_t muscle, std::int32_t bone, float depth) {
  return {.muscle = muscle, .bone = bone, .depth = depth};
}
PairDepth in_muscle(std::uint32_t muscle, std::uint32_t other, float depth) {
  return {.muscle = muscle, .other = other, .depth = depth};
}

TEST(Penetration, NothingIsBeyondNothing) {
  const DepthsBeyond none = beyond({}, {});
  EXPECT_EQ(none.bone, 0.0f);
  EXPECT_EQ(none.muscle, 0.0f);
  EXPECT_EQ(none.bone_pair, 0.0f);
  EXPECT_EQ(none.muscle_pair, 0.0f);
  EXPECT_EQ(deepest({}).depth, 0.0f);
}

TEST(Penetration, WhatIsBeyondIsNeverLessThanZero) {
  const Penetration rest{.bones = {in_bone(0, 1, 0.5f)}, .muscles = {in_muscle(0, 1, 0.5f)}};
  const Penetration now{.bones = {in_bone(0, 1, 0.25f)}, .muscles = {in_muscle(0, 1, 0.25f)}};
  const DepthsBeyond less = beyond(now, rest);
  EXPECT_EQ(less.bone, 0.0f);
  EXPECT_EQ(less.muscle, 0.0f);
  EXPECT_EQ(less.bone_pair, 0.0f);
  EXPECT_EQ(less.muscle_pair, 0.0f);
}

TEST(Penetration, APairIsComparedWithItself) {
  const Penetration rest{.bones = {in_bone(0, 0, 0.5f), in_bone(0, 1, 0.125f), in_bone(1, 0, 0.25f)},
                         .muscles = {in_muscle(0, 1, 0.25f), in_muscle(1, 2, 0.5f)}};
  // The deepest pair has gone flat and others have become as deep; the other's surface is now the deeper.
  const Penetration now{.bones = {in_bone(0, 1, 0.5f), in_bone(1, 0, 0.375f), in_bone(2, 0, 0.125f)},
                        .muscles = {in_muscle(1, 0, 0.5f), in_muscle(0, 2, 0.375f), in_muscle(2, 1, 0.625f)}};
  const DepthsBeyond more = beyond(now, rest);
  EXPECT_EQ(more.bone, 0.0f);
  EXPECT_EQ(more.bone_pair, 0.375f);
  EXPECT_EQ(more.muscle, 0.125f);
  EXPECT_EQ(more.muscle_pair, 0.375f);
  EXPECT_EQ(depth_of(in_muscle(1, 0, 0.0f), rest), 0.25f);
  EXPECT_EQ(depth_of(in_bone(2, 0, 0.0f), rest), 0.0f);
  EXPECT_EQ(deepest(now.muscles).muscle, 2u);
}

}  // namespace
}  // namespace fascicle::muscle
