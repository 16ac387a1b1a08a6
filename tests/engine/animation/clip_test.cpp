#include "engine/animation/clip.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "engine/content/gltf_reader.hpp"
#include "tests/support/test_data.hpp"

namespace fascicle {
namespace {

constexpr float kHalf = std::numbers::sqrt2_v<float> / 2.0f;
constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();

// A clip of one channel on bone 0.
Clip make_clip(ClipTarget target, ClipInterpolation interpolation, std::vector<float> times,
               std::vector<glm::vec4> values) {
  Clip clip;
  clip.start = times.front();
  clip.end = times.back();
  clip.channels.push_back({0, target, interpolation, 0, static_cast<std::uint32_t>(times.size()), 0});
  clip.times = std::move(times);
  clip.values = std::move(values);
  return clip;
}

Trs sample(const Clip& clip, float time) {
  std::vector<Trs> pose(1);
  sample_clip(clip, time, pose);
  return pose[0];
}

glm::vec4 turn_about_z(float degrees) {
  const float half = degrees * std::numbers::pi_v<float> / 360.0f;
  return {0, 0, std::sin(half), std::cos(half)};
}

TEST(SampleClip, ChannelsOfOtherSkeletonsAreLeftOut) {
  Clip clip = make_clip(ClipTarget::kTranslation, ClipInterpolation::kLinear, {0, 1}, {{0, 0, 0, 0}, {1, 0, 0, 0}});
  for (const std::int32_t bone : {-1, 1, 1000000}) {
    clip.channels[0].bone = bone;
    EXPECT_EQ(sample(clip, 0.5f).translation, glm::vec3(0));
  }
}

TEST(SampleClip, NotANumberAsTimeGivesTheStart) {
  const Clip clip =
      make_clip(ClipTarget::kTranslation, ClipInterpolation::kLinear, {0, 1}, {{3, 0, 0, 0}, {1, 0, 0, 0}});
  for (const float time : {kNan, kInfinity, -kInfinity}) EXPECT_EQ(sample(clip, time).translation.x, 3.0f);
}

TEST(SampleClip, StepHoldsUntilExactlyTheNextKey) {
  const Clip clip = make_clip(ClipTarget::kTranslation, ClipInterpolation::kStep, {0.25f, 0.5f, 1.0f},
                              {{1, 0, 0, 0}, {2, 0, 0, 0}, {3, 0, 0, 0}});
  const auto x = [&](float time) { return sample(clip, time).translation.x; };
  EXPECT_EQ(x(-1.0f), 1.0f);
  EXPECT_EQ(x(0.25f), 1.0f);
  EXPECT_EQ(x(std::nextafter(0.5f, 0.0f)), 1.0f);
  EXPECT_EQ(x(0.5f), 2.0f);
  EXPECT_EQ(x(std::nextafter(1.0f, 0.0f)), 2.0f);
  EXPECT_EQ(x(1.0f), 3.0f);
  EXPECT_EQ(x(9.0f), 3.0f);
}

TEST(SampleClip, LinearVectorsMix) {
  const Clip clip = make_clip(ClipTarget::kScale, ClipInterpolation::kLinear, {1, 3}, {{1, 2, 3, 0}, {3, 6, 3, 0}});
  EXPECT_EQ(sample(clip, 0).scale, glm::vec3(1, 2, 3));
  EXPECT_EQ(sample(clip, 1.5f).scale, glm::vec3(1.5f, 3, 3));
  EXPECT_EQ(sample(clip, 3).scale, glm::vec3(3, 6, 3));
}

TEST(SampleClip, LinearRotationsTurnAtConstantSpeed) {
  const Clip clip =
      make_clip(ClipTarget::kRotation, ClipInterpolation::kLinear, {0, 1}, {turn_about_z(0), turn_about_z(120)});
  for (const float t : {0.0f, 0.25f, 0.5f, 1.0f}) {
    const glm::quat q = sample(clip, t).rotation;
    const glm::vec4 expected = turn_about_z(120 * t);
    EXPECT_NEAR(q.z, expected.z, 1e-6f);
    EXPECT_NEAR(q.w, expected.w, 1e-6f);
  }
}

TEST(SampleClip, LinearRotationsGoTheShortWay) {
  // The second key is a turn by 60 degrees with the sign of all components changed.
  const Clip clip =
      make_clip(ClipTarget::kRotation, ClipInterpolation::kLinear, {0, 1}, {turn_about_z(0), -turn_about_z(60)});
  const glm::quat q = sample(clip, 0.5f).rotation;
  EXPECT_NEAR(std::abs(q.w), std::cos(std::numbers::pi / 12), 1e-6);  // 30 degrees
}

TEST(SampleClip, OppositeRotationsStayFinite) {
  const Clip clip =
      make_clip(ClipTarget::kRotation, ClipInterpolation::kLinear, {0, 1}, {turn_about_z(0), turn_about_z(180)});
  for (float t = 0; t <= 1; t += 0.125f) EXPECT_NEAR(glm::length(sample(clip, t).rotation), 1.0f, 1e-6f);
}

// glTF 2.0, appendix C, by hand: v = 1, out-tangent b = 2, next in-tangent a = -4, next v = 5, keys 2 s apart, t =
// 0.25: (2t^3 - 3t^2 + 1) 1 + 2 (t^3 - 2t^2 + t) 2 + (-2t^3 + 3t^2) 5 + 2 (t^3 - t^2) (-4) = 0.84375 + 0.5625 + 0.78125
// + 0.375 = 2.5625.
TEST(SampleClip, CubicSplinesFollowTheSpecification) {
  const Clip clip = make_clip(ClipTarget::kTranslation, ClipInterpolation::kCubicSpline, {1, 3},
                              {{9, 0, 0, 0}, {1, 0, 0, 0}, {2, 0, 0, 0}, {-4, 0, 0, 0}, {5, 0, 0, 0}, {9, 0, 0, 0}});
  EXPECT_FLOAT_EQ(sample(clip, 1.5f).translation.x, 2.5625f);
  EXPECT_EQ(sample(clip, 1).translation.x, 1.0f);
  EXPECT_EQ(sample(clip, 3).translation.x, 5.0f);
  EXPECT_EQ(sample(clip, 0).translation.x, 1.0f);
  EXPECT_EQ(sample(clip, 4).translation.x, 5.0f);
}

TEST(SampleClip, CubicRotationsAreMadeUnit) {
  const glm::vec4 none(0);
  const Clip clip = make_clip(ClipTarget::kRotation, ClipInterpolation::kCubicSpline, {0, 1},
                              {none, turn_about_z(0), none, none, turn_about_z(90), none});
  const glm::quat q = sample(clip, 0.5f).rotation;  // halfway by symmetry
  EXPECT_NEAR(q.z, std::sin(std::numbers::pi / 8), 1e-6);
  EXPECT_NEAR(q.w, std::cos(std::numbers::pi / 8), 1e-6);
}

TEST(SampleClip, CubicSplinesThroughNothingHoldTheKeyBefore) {
  const glm::vec4 none(0), key(0, 0, kHalf, kHalf);
  // From q to -q: the middle is zero, which no rotation is.
  const Clip clip =
      make_clip(ClipTarget::kRotation, ClipInterpolation::kCubicSpline, {0, 1}, {none, key, none, none, -key, none});
  EXPECT_EQ(sample(clip, 0.5f).rotation, glm::quat(kHalf, 0, 0, kHalf));
  const glm::vec4 huge(3e38f);
  const Clip wild = make_clip(ClipTarget::kTranslation, ClipInterpolation::kCubicSpline, {0, 100},
                              {huge, none, huge, -huge, none, huge});
  EXPECT_EQ(sample(wild, 50).translation, glm::vec3(0));
}

TEST(SampleClip, ASingleKeyHolds) {
  const Clip clip = make_clip(ClipTarget::kTranslation, ClipInterpolation::kLinear, {2}, {{1, 2, 3, 0}});
  for (const float time : {0.0f, 2.0f, 4.0f}) EXPECT_EQ(sample(clip, time).translation, glm::vec3(1, 2, 3));
  EXPECT_EQ(wrap_clip_time(clip, 5, true), 0.0f);
}

TEST(WrapClipTime, LoopsAndClamps) {
  const Clip clip =
      make_clip(ClipTarget::kTranslation, ClipInterpolation::kLinear, {0.5f, 2.5f}, {glm::vec4(0), glm::vec4(1)});
  EXPECT_EQ(wrap_clip_time(clip, 1.5f, true), 1.5f);
  EXPECT_EQ(wrap_clip_time(clip, 2.0f, true), 0.0f);
  EXPECT_EQ(wrap_clip_time(clip, 4.5f, true), 0.5f);
  EXPECT_EQ(wrap_clip_time(clip, -0.5f, true), 1.5f);
  EXPECT_EQ(wrap_clip_time(clip, -1e-20f, true), 0.0f);
  EXPECT_EQ(wrap_clip_time(clip, 4.5f, false), 2.0f);
  EXPECT_EQ(wrap_clip_time(clip, -1.0f, false), 0.0f);
  EXPECT_EQ(wrap_clip_time(clip, kNan, true), 0.0f);
  EXPECT_EQ(wrap_clip_time(clip, kInfinity, true), 0.0f);
}

TEST(ClipData, CesiumManWalksWithinReason) {
  FASCICLE_SKIP_WITHOUT_DATA("gltf/CesiumMan.glb");
  const Result<GltfFile> file = read_gltf(test::data_folder() / "gltf/CesiumMan.glb");
  ASSERT_TRUE(file.ok()) << to_text(file.diagnostics());
  const Clip& clip = file->clips.at(0);
  std::vector<Trs> pose = file->skeleton.rest_local;
  std::vector<glm::mat4> world(pose.size());
  float travel = 0.0f;
  glm::vec3 foot_before(0);
  for (int frame = 0; frame <= 120; ++frame) {
    sample_clip(clip, clip.start + clip.duration() * static_cast<float>(frame) / 120.0f, pose);
    compose(file->skeleton, pose, glm::mat4(1.0f), world);
    for (const glm::mat4& bone : world) {
      const glm::vec3 at(bone[3]);
      ASSERT_TRUE(std::isfinite(at.x) && std::isfinite(at.y) && std::isfinite(at.z));
      ASSERT_LT(std::abs(at.x), 0.8f);
      ASSERT_LT(std::abs(at.z), 0.8f);
      ASSERT_GT(at.y, -0.1f);
      ASSERT_LT(at.y, 1.4f);
    }
    const glm::vec3 foot(world[static_cast<std::size_t>(file->skeleton.find("leg_joint_R_5"))][3]);
    if (frame > 0) travel += glm::distance(foot, foot_before);
    foot_before = foot;
  }
  EXPECT_GT(travel, 0.5f);  // it does walk
}

}  // namespace
}  // namespace fascicle
