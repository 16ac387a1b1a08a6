// Rest radii: the belly has the volume asked for, by every way of asking.
#include <cmath>

#include <gtest/gtest.h>

#include "modules/muscle/asset/build_muscle_asset.hpp"
#include "tests/support/synthetic_muscles.hpp"

namespace fascicle::muscle {
namespace {

// A straight muscle down one bone, 0.3 m, without a tendon.
MuscleDescription straight() {
  MuscleDescription muscle;
  muscle.name = "straight";
  muscle.attachments = {{0, {0.0f, 0.0f, 0.0f}, true}, {0, {0.0f, -0.3f, 0.0f}, true}};
  muscle.hill.optimal_fibre_length = 0.1f;
  muscle.section_vertices = 36;
  muscle.longitudinal_subdivision = 3;
  return muscle;
}

std::shared_ptr<const MuscleAsset> build(const MuscleDescription& muscle) {
  const auto result = build_muscle_asset(std::vector{muscle}, std::vector{glm::mat4(1.0f)});
  EXPECT_TRUE(result.ok()) << to_text(result.diagnostics());
  return result.ok() ? *result : nullptr;
}

TEST(RestShape, VolumeIsMet) {
  MuscleDescription muscle = straight();
  muscle.volume = 2.5e-4f;
  EXPECT_NEAR(build(muscle)->muscles[0].rest_volume, 2.5e-4f, 2.5e-8f);
}

TEST(RestShape, PcsaGivesVolumeByTheFibres) {
  MuscleDescription muscle = straight();
  muscle.pcsa = 0.002f;
  muscle.volume = 1.0f;  // PCSA comes first
  muscle.hill.pennation = 0.4f;
  const float expected = 0.002f * 0.1f / std::cos(0.4f);
  EXPECT_NEAR(build(muscle)->muscles[0].rest_volume, expected, 1.0e-4f * expected);
}

TEST(RestShape, ForceGivesPcsa) {
  MuscleDescription muscle = straight();
  muscle.hill.max_isometric_force = 1220.0f;
  const float by_default = 1220.0f / 61.0e4f * 0.1f;
  EXPECT_NEAR(build(muscle)->muscles[0].rest_volume, by_default, 1.0e-4f * by_default);
  muscle.specific_tension = 32.0e4f;
  const float weak = 1220.0f / 32.0e4f * 0.1f;
  EXPECT_NEAR(build(muscle)->muscles[0].rest_volume, weak, 1.0e-4f * weak);
}

TEST(RestShape, AbsoluteProfileIsTakenAsItIs) {
  MuscleDescription muscle = straight();
  muscle.profile = {{0.0f, 0.5f, 1.0f}, {0.01f, 0.03f, 0.02f}, true};
  const auto asset = build(muscle);
  EXPECT_FLOAT_EQ(asset->rest_radii[asset->radius(0, 0)], 0.01f);
  EXPECT_FLOAT_EQ(asset->rest_radii[asset->radius(0, 4)], 0.03f);
  EXPECT_FLOAT_EQ(asset->rest_radii[asset->radius(0, 6) + 35], 0.025f);
  // Frusta of a regular 36-gon: h A (r0^2 + r0 r1 + r1^2) / 3 by pieces, but for the tetrahedra's chords.
  const double area = 18.0 * std::sin(6.283185307 / 36.0);
  const double frusta = 0.15 / 3.0 * area * (1e-4 + 3e-4 + 9e-4 + 9e-4 + 6e-4 + 4e-4);
  EXPECT_NEAR(asset->muscles[0].rest_volume, frusta, 2.0e-3 * frusta);
}

TEST(RestShape, RelativeProfileIsScaled) {
  MuscleDescription muscle = straight();
  muscle.volume = 3.0e-4f;
  muscle.profile = {{0.0f, 1.0f}, {5.0f, 5.0f}, false};
  const auto asset = build(muscle);
  const double area = 18.0 * std::sin(6.283185307 / 36.0);
  EXPECT_NEAR(asset->rest_radii[asset->radius(0, 0)], std::sqrt(3.0e-4 / 0.3 / area), 1.0e-6);
}

TEST(RestShape, BentMusclesMeetTheirVolumesToo) {
  std::vector<MuscleDescription> muscles = test::synthetic_muscles(8, 1);
  for (std::size_t i = 0; i < muscles.size(); ++i) muscles[i].volume = 1.0e-4f + 1.0e-5f * static_cast<float>(i);
  const auto result = build_muscle_asset(muscles, test::rest_bones());
  ASSERT_TRUE(result.ok()) << to_text(result.diagnostics());
  for (std::size_t i = 0; i < muscles.size(); ++i) {
    EXPECT_NEAR((*result)->muscles[i].rest_volume / *muscles[i].volume, 1.0f, 1.0e-4f) << i;
  }
}

TEST(RestShape, FittedRadiiStay) {
  const MuscleDescription muscle = straight();
  std::vector<MuscleFit> fits(1);
  for (int i = 0; i < 9 * 36; ++i) fits[0].radii.push_back(0.001f * static_cast<float>(i % 17) - 0.002f);
  const auto result = build_muscle_asset(std::vector{muscle}, std::vector{glm::mat4(1.0f)}, fits);
  ASSERT_TRUE(result.ok()) << to_text(result.diagnostics());
  for (std::uint32_t k = 0; k < 9; ++k) {
    for (std::uint32_t i = 0; i < 36; ++i) {
      EXPECT_EQ((*result)->rest_radii[(*result)->radius(0, k) + i], fits[0].radii[36 * k + i]);
    }
  }
}

}  // namespace
}  // namespace fascicle::muscle
