// Chains of levels: what does not belong together is told; what does morphs into the next coarser surface.
#include "modules/muscle/asset/muscle_levels.hpp"

#include <functional>
#include <string>

#include <gmock/gmock.h>
#include <glm/gtc/matrix_transform.hpp>

#include "tests/support/leveled_state.hpp"
#include "tests/support/synthetic_levels.hpp"

namespace fascicle::muscle {
namespace {

using testing::HasSubstr;
using Muscles = std::vector<MuscleDescription>;

struct Mismatch {
  const char* name;
  std::function<void(Muscles&)> change;  // of the coarser level
  const char* says;
};

class MismatchedLevels : public testing::TestWithParam<Mismatch> {};

TEST_P(MismatchedLevels, AreRefusedByTheMusclesName) {
  Muscles muscles = test::synthetic_muscles(24, 2);
  const auto fine = test::synthetic_level(muscles);
  test::coarsen(muscles);
  GetParam().change(muscles);
  const auto result = make_muscle_levels(std::vector{fine, test::synthetic_level(muscles)});
  ASSERT_FALSE(result.ok());
  EXPECT_THAT(to_text(result.diagnostics()), HasSubstr(GetParam().says));
}

INSTANTIATE_TEST_SUITE_P(
    , MismatchedLevels,
    testing::Values(
        Mismatch{"Fewer", [](Muscles& m) { m.pop_back(); }, "level 1: 47 muscles; the next finer level has 48"},
        Mismatch{"OtherOrder", [](Muscles& m) { std::swap(m[3], m[5]); },
                 "left_3: the coarser level has \"left_5\" in its place"},
        Mismatch{"MovedAttachment", [](Muscles& m) { m[9].attachments[1].position.x += 0.01f; },
                 "left_9: the coarser level has other attachments"},
        Mismatch{"OtherBone", [](Muscles& m) { m[0].attachments[1].bone = test::kFootRight; },
                 "left_0: the coarser level has other attachments"},
        Mismatch{"ViaPointLeftOut", [](Muscles& m) { m[9].attachments.erase(m[9].attachments.begin() + 1); },
                 "left_9: the coarser level has other attachments"},
        Mismatch{"OtherTendon", [](Muscles& m) { m[2].tendon_at_origin = 0.2f; },
                 "left_2: the coarser level has other tendons"},
        Mismatch{"UnevenVertices", [](Muscles& m) { m[1].section_vertices = 10; },
                 "left_1: section_vertices goes from 24 to 10; keep it or halve it"},
        Mismatch{"MoreVertices", [](Muscles& m) { m[1].section_vertices = 48; }, "goes from 24 to 48"},
        Mismatch{"TwoSubdivisionsAtOnce", [](Muscles& m) { m[1].longitudinal_subdivision = 0; },
                 "left_1: longitudinal_subdivision goes from 2 to 0; keep it or lower it by one"}),
    [](const auto& row) { return std::string(row.param.name); });

TEST(MuscleLevels, AFitOfTheCoarserLevelAloneIsRefused) {
  Muscles muscles = test::synthetic_muscles(24, 2);
  const auto unfitted = build_muscle_asset(muscles, test::rest_bones());
  ASSERT_TRUE(unfitted.ok());
  // Displaced at its attachments too: the finer level's length would follow.
  test::coarsen(muscles);
  std::vector<MuscleFit> fits(muscles.size());
  fits[4] = test::synthetic_fit(muscles[4], 4, 0.0f);
  fits[4].displacements.front() = glm::vec3(0.002f, 0.0f, 0.0f);
  const auto fitted = build_muscle_asset(muscles, test::rest_bones(), fits);
  ASSERT_TRUE(fitted.ok());
  const auto result = make_muscle_levels(std::vector{*unfitted, *fitted});
  ASSERT_FALSE(result.ok());
  EXPECT_EQ(result.diagnostics().errors.size(), 1u);
  EXPECT_THAT(to_text(result.diagnostics()), HasSubstr("left_4: a fit has displaced the coarser level's sections"));
}

TEST(MuscleLevels, AllMismatchesAreToldAtOnce) {
  Muscles muscles = test::synthetic_muscles(24, 2);
  const auto fine = test::synthetic_level(muscles);
  test::coarsen(muscles);
  muscles[1].section_vertices = 10;
  muscles[7].longitudinal_subdivision = 0;
  const auto result = make_muscle_levels(std::vector{fine, test::synthetic_level(muscles)});
  ASSERT_FALSE(result.ok());
  EXPECT_EQ(result.diagnostics().errors.size(), 2u);
}

TEST(CoarserLevel, HalvesWhatStaysEvenAndSix) {
  EXPECT_EQ(coarser_level({36, 2}), (MuscleLevel{18, 1}));
  EXPECT_EQ(coarser_level({24, 1}), (MuscleLevel{12, 1}));  // a belly needs a section
  EXPECT_EQ(coarser_level({18, 1}), (MuscleLevel{18, 1}));  // 9 is odd
  EXPECT_EQ(coarser_level({12, 0}), (MuscleLevel{6, 0}));
  EXPECT_EQ(coarser_level({10, 3}), (MuscleLevel{10, 2}));
  EXPECT_EQ(coarser_level({8, 0}), (MuscleLevel{8, 0}));    // 4 is less than six
  EXPECT_EQ(coarser_level({6, 0}), (MuscleLevel{6, 0}));
}

TEST(MuscleLevels, OneLevelHasNothingToMorphInto) {
  const auto levels = test::synthetic_levels({12, 1}, 1);
  EXPECT_TRUE(levels->morphs.empty());
  EXPECT_GT(levels->radius, 0.3f);
}

TEST(MuscleLevels, EverySurfaceLiesWithinTheRadiusAroundTheAnchor) {
  const auto levels = test::synthetic_levels();
  const MuscleAsset& asset = *levels->assets.front();
  const glm::vec3 anchor(asset.rest_x[levels->anchor.slot], asset.rest_y[levels->anchor.slot],
                         asset.rest_z[levels->anchor.slot]);
  test::LeveledState state(levels);
  state.step(mtu_kernels(detect_simd()), test::rest_bones(), true);
  float furthest = 0.0f;
  for (const SurfaceVertex& vertex : state.surfaces.vertices) {
    furthest = std::max(furthest, glm::distance(vertex.position, anchor));
  }
  EXPECT_LE(furthest, levels->radius);
  EXPECT_GT(furthest, 0.9f * levels->radius);
}

// The points of a morphed level lie on the coarser level's polyline, in any pose.
TEST(MuscleLevels, MorphedPointsLieOnTheCoarserLine) {
  const auto levels = test::synthetic_levels();
  for (std::uint32_t level = 0; level < 2; ++level) {
    test::LeveledState fine(levels, {level, 1.0f}), coarse(levels, {level + 1, 0.0f});
    for (const float seconds : {0.1f, 0.35f, 0.8f}) {
      fine.step(mtu_kernels(detect_simd()), test::walk_bones(seconds), true);
      coarse.step(mtu_kernels(detect_simd()), test::walk_bones(seconds), true);
      for (std::uint32_t m = 0; m < fine.asset().size(); ++m) {
        for (std::uint32_t k = 0; k < fine.asset().muscles[m].section_count; ++k) {
          const glm::vec3 expected = 0.5f * (coarse.point(m, k / 2) + coarse.point(m, (k + 1) / 2));
          ASSERT_LT(glm::distance(fine.point(m, k), expected), 1.0e-6f) << m << " " << k;
        }
        // So does the functional length, which sees neither level nor fit.
        ASSERT_EQ(fine.asset().muscles[m].attachment_count, coarse.asset().muscles[m].attachment_count);
      }
    }
  }
}

// One muscle with round sections of changing radius on a straight line: the morphed surface is the coarser one exactly.
TEST(MuscleLevels, AStraightMuscleMorphsOntoTheCoarserSurface) {
  MuscleDescription muscle;
  muscle.name = "cone";
  muscle.attachments = {{0, {0.0f, 0.0f, 0.0f}, true}, {1, {0.0f, -0.4f, 0.0f}, true}};
  muscle.profile = {.fractions = {0.0f, 0.5f, 1.0f}, .radii = {0.01f, 0.04f, 0.005f}, .absolute = true};
  const std::vector<glm::mat4> bones(2, glm::mat4(1.0f));
  std::vector<std::shared_ptr<const MuscleAsset>> assets;
  for (const MuscleLevel level : {MuscleLevel{24, 3}, MuscleLevel{12, 2}, MuscleLevel{12, 1}, MuscleLevel{6, 1}}) {
    muscle.section_vertices = level.section_vertices;
    muscle.longitudinal_subdivision = level.longitudinal_subdivision;
    assets.push_back(*build_muscle_asset(std::vector{muscle}, bones));
  }
  const auto built = make_muscle_levels(assets);
  ASSERT_TRUE(built.ok()) << to_text(built.diagnostics());
  for (std::uint32_t level = 0; level < 3; ++level) {
    test::LeveledState fine(*built, {level, 1.0f}), coarse(*built, {level + 1, 0.0f}), plain(*built, {level, 0.0f});
    for (test::LeveledState* state : {&fine, &coarse, &plain}) {
      state->step(mtu_kernels(detect_simd()), bones, true);
    }
    EXPECT_LT(test::SurfaceGap(fine, coarse).max(), 1.0e-6f) << level;
    // Vertices between two that stay lie on the chord between them.
    const float half = 6.2831853f / static_cast<float>(assets[level]->muscles[0].section_vertices);
    if (assets[level]->muscles[0].section_vertices != assets[level + 1]->muscles[0].section_vertices) {
      EXPECT_GT(test::SurfaceGap(plain, coarse).max(), 0.02f * (1.0f - std::cos(half))) << level;
      const std::uint32_t k = 1u << (assets[level]->muscles[0].subdivision - 1);  // the middle
      const float* radii = &(*built)->morphs[level].radii[assets[level]->radius(0, k)];
      EXPECT_NEAR(radii[0], 0.04f, 1.0e-7f);
      EXPECT_NEAR(radii[1], 0.04f * std::cos(half), 1.0e-7f);
    }
  }
}

TEST(MuscleLevels, ErrorsAddUpAndBandsDoNotOverlap) {
  for (const float noise : {0.0f, 0.1f}) {
    const auto levels = test::synthetic_levels({36, 3}, 3, noise);
    EXPECT_GT(levels->morphs[0].error, 0.0f);
    EXPECT_FLOAT_EQ(levels->morphs[0].complete, levels->morphs[0].error);
    EXPECT_GE(levels->morphs[1].complete, levels->morphs[0].error + levels->morphs[1].error - 1.0e-7f);
    EXPECT_GE(levels->morphs[1].complete, kMorphBand * levels->morphs[0].complete);
  }
  // Levels that do not differ still have an order.
  const auto asset = test::synthetic_level(test::synthetic_muscles(8, 0));
  const auto same = make_muscle_levels(std::vector{asset, asset});
  ASSERT_TRUE(same.ok());
  EXPECT_NEAR((*same)->morphs[0].error, 0.0f, 1.0e-6f);
  EXPECT_GT((*same)->morphs[0].complete, 0.0f);
}

// Where the line's start passes 26 degrees from the origin bone's z axis, vertices are counted from its y axis. Levels
// on either side of that still match vertex by vertex, and the finer one is not seen to turn.
TEST(MuscleLevels, LevelsThatStartFromOtherDirectionsDoNotTurn) {
  MuscleDescription muscle;
  muscle.name = "steep";
  const float angle = 0.455f;  // rad: cos = 0.898
  const glm::vec3 along(std::sin(angle), 0.0f, std::cos(angle));
  muscle.attachments = {{0, glm::vec3(0.0f), true}, {0, 0.3f * along, true}};
  const std::vector<glm::mat4> bones(1, glm::mat4(1.0f));
  std::vector<std::shared_ptr<const MuscleAsset>> assets;
  for (const MuscleLevel level : {MuscleLevel{24, 1}, MuscleLevel{12, 0}}) {
    muscle.section_vertices = level.section_vertices;
    muscle.longitudinal_subdivision = level.longitudinal_subdivision;
    const std::uint32_t sections = (1u << level.longitudinal_subdivision) + 1;
    MuscleFit fit;
    fit.displacements.assign(sections, glm::vec3(0.0f));
    fit.radii.assign(std::size_t{sections} * level.section_vertices, 0.02f);
    if (sections == 3) fit.displacements[1] = glm::vec3(-0.004f, 0.0f, 0.0f);
    assets.push_back(*build_muscle_asset(std::vector{muscle}, bones, std::vector{fit}));
  }
  const auto built = make_muscle_levels(assets);
  ASSERT_TRUE(built.ok());
  test::LeveledState plain(*built), fine(*built, {0, 1.0f}), coarse(*built, {1, 0.0f});
  for (test::LeveledState* state : {&plain, &fine, &coarse}) state->step(mtu_kernels(detect_simd()), bones, true);
  EXPECT_LT(std::abs(glm::dot(plain.u(0, 0), coarse.u(0, 0))), 0.1f);  // a quarter turn apart
  EXPECT_GT(glm::dot(plain.u(0, 0), fine.u(0, 0)), std::cos(3.14159265f / 24.0f + 0.02f));
  EXPECT_LT(test::SurfaceGap(fine, coarse).max(), 1.0e-6f);
}

}  // namespace
}  // namespace fascicle::muscle
