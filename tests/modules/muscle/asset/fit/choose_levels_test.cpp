#include "modules/muscle/asset/fit/choose_levels.hpp"

#include <limits>
#include <string>

#include <gtest/gtest.h>

#include "modules/muscle/asset/fit/check_mesh.hpp"
#include "modules/muscle/asset/fit/compare_fit.hpp"
#include "tests/support/shapes.hpp"

namespace fascicle::muscle {
namespace {

// A muscle along the z axis inside a ball of 10 cm, stretched to half a metre.
class ChooseLevels : public testing::Test {
 protected:
  ChooseLevels() : ball(test::make_sphere(0.1f, 30, 45)) {
    for (glm::vec3& position : ball.positions) position.z *= 2.5f;
    description.name = "m";
    description.attachments = {{0, {0, 0, -0.249f}}, {0, {0, 0, 0.249f}}};
    description.volume = 1e-3f;
    description.section_vertices = 14;
    description.longitudinal_subdivision = 3;
  }

  ChosenLevel choose(float bound) {
    const FitInput input{.description = &description, .mesh = mesh, .areas = {}};
    return choose_levels({&input, 1}, {&bound, 1}, bones).front();
  }

  MuscleDescription at_level(MuscleLevel level) {
    MuscleDescription at = description;
    at.section_vertices = level.section_vertices;
    at.longitudinal_subdivision = level.longitudinal_subdivision;
    return at;
  }

  FittedMuscle fit_at(MuscleLevel level) {
    const MuscleDescription at = at_level(level);
    const FitInput input{.description = &at, .mesh = mesh, .areas = {}};
    return fit_muscles({&input, 1}, bones)[0];
  }

  // The largest distance that a level leaves, found without the search.
  double distance_at(MuscleLevel level) {
    const MuscleDescription at = at_level(level);
    const FittedMuscle fitted = fit_at(level);
    const auto asset = build_muscle_asset({&at, 1}, bones, {&fitted.fit, 1});
    return compare_fit(**asset, 0, MeshOracle(*mesh)).max();
  }

  TriangleMesh ball;
  const TriangleMesh* mesh = &ball;
  MuscleDescription description;
  std::vector<glm::mat4> bones{glm::mat4(1.0f)};
};

TEST_F(ChooseLevels, NothingToChooseForNothing) { EXPECT_TRUE(choose_levels({}, {}, bones).empty()); }

TEST_F(ChooseLevels, WithoutAMeshTheLevelStays) {
  mesh = nullptr;
  const ChosenLevel choice = choose(1e-3f);
  EXPECT_EQ(choice.level, (MuscleLevel{14, 3}));
  EXPECT_TRUE(choice.kept);
}

TEST_F(ChooseLevels, WhatCannotBeFittedKeepsItsLevel) {
  const TriangleMesh far = test::moved(ball, glm::mat4{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {5, 0, 0, 1}});
  mesh = &far;
  EXPECT_EQ(choose(1e-3f).level, (MuscleLevel{14, 3}));
}

TEST_F(ChooseLevels, AMuscleWithBothEndsOffTheMeshIsFittedAtHigherLevels) {
  for (const float sign : {-1.0f, 1.0f}) description.attachments[sign < 0 ? 0 : 1].position.z = sign * 0.28f;
  ASSERT_TRUE(fit_at({36, 0}).fit.radii.empty());
  ASSERT_FALSE(fit_at({6, 3}).fit.radii.empty());
  const ChosenLevel loose = choose(0.08f);
  EXPECT_TRUE(loose.kept);
  EXPECT_GT(loose.distance, 0.0f);
  EXPECT_LE(loose.distance, 0.08f);
  const ChosenLevel impossible = choose(1e-5f);
  EXPECT_FALSE(impossible.kept);
  EXPECT_NEAR(distance_at(impossible.level), impossible.distance, 1e-6);
}

TEST_F(ChooseLevels, AMuscleThatCannotBeBuiltDoesNotStopOthers) {
  MuscleDescription broken = description;
  broken.name = "broken";
  broken.attachments[0].position.x = std::numeric_limits<float>::quiet_NaN();
  const TriangleMesh copy = ball;
  for (const TriangleMesh* its : {mesh, &copy}) {
    const std::vector<FitInput> inputs{{&broken, its, {}}, {&description, mesh, {}}};
    const std::vector<ChosenLevel> choices = choose_levels(inputs, std::vector{0.015f, 0.015f}, bones);
    EXPECT_EQ(choices[0].level, (MuscleLevel{14, 3}));
    EXPECT_EQ(choices[1].level, choose(0.015f).level);
    EXPECT_GT(choices[1].distance, 0.0f);
  }
}

TEST_F(ChooseLevels, OfADefectiveMeshDistancesAreThoseOfALaterFit) {
  ball.indices.erase(ball.indices.begin() + 600, ball.indices.begin() + 606);
  const ChosenLevel choice = choose(0.015f);
  EXPECT_TRUE(choice.kept);
  EXPECT_NEAR(distance_at(choice.level), choice.distance, 1e-4);  // here to the mesh as it is, not mended
  // A mesh that was checked before gives the same fit.
  const MuscleDescription at = at_level(choice.level);
  const CheckedMesh checked = check_mesh(ball);
  ASSERT_FALSE(checked.sound);
  const FitInput input{.description = &at, .mesh = mesh, .areas = {}, .checked = &checked};
  EXPECT_EQ(fit_muscles({&input, 1}, bones)[0].fit.radii, fit_at(choice.level).fit.radii);
}

TEST_F(ChooseLevels, HeadsOfOneMeshKeepTheirBoundsTogether) {
  std::vector<MuscleDescription> heads(3, description);
  for (int i = 0; i < 3; ++i) {
    MuscleDescription& head = heads[static_cast<std::size_t>(i)];
    head.name += std::to_string(i);
    for (AttachmentDescription& end : head.attachments) {
      end.position = {0.04f * static_cast<float>(i - 1), 0.0f, 0.9f * end.position.z};
    }
  }
  std::vector<FitInput> inputs;
  for (const MuscleDescription& head : heads) inputs.push_back({&head, mesh, {}});
  const std::vector<float> bounds{0.03f, 0.04f, 0.05f};
  const std::vector<ChosenLevel> choices = choose_levels(inputs, bounds, bones);
  for (std::size_t i = 0; i < 3; ++i) {
    heads[i].section_vertices = choices[i].level.section_vertices;
    heads[i].longitudinal_subdivision = choices[i].level.longitudinal_subdivision;
  }
  std::vector<MuscleFit> fits;
  for (const FittedMuscle& fitted : fit_muscles(inputs, bones)) fits.push_back(fitted.fit);
  const auto asset = build_muscle_asset(heads, bones, fits);
  ASSERT_TRUE(asset.ok()) << to_text(asset.diagnostics());
  const std::vector<FitComparison> found = compare_heads(**asset, std::vector{0u, 1u, 2u}, MeshOracle(*mesh));
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(choices[i].distance, found[i].max(), 1e-6);
    EXPECT_EQ(choices[i].kept, choices[i].distance <= bounds[i]);
    EXPECT_TRUE(choices[i].kept) << i << ": " << choices[i].distance;
  }
}

TEST_F(ChooseLevels, KeepsTheBound) {
  for (const float bound : {0.05f, 0.015f, 0.005f}) {
    const ChosenLevel choice = choose(bound);
    ASSERT_TRUE(choice.kept) << bound;
    EXPECT_LE(choice.distance, bound);
    EXPECT_NEAR(distance_at(choice.level), choice.distance, 1e-6);
  }
}

TEST_F(ChooseLevels, TakesTheFewestVerticesThatDo) {
  const float bound = 0.015f;
  const MuscleLevel chosen = choose(bound).level;
  const std::uint32_t cost = chosen.section_vertices << chosen.longitudinal_subdivision;
  for (const std::uint32_t count : {6u, 8u, 10u, 12u, 16u, 20u, 24u}) {
    for (std::uint32_t subdivision = 0; subdivision <= 4; ++subdivision) {
      if (count << subdivision >= cost) continue;
      EXPECT_GT(distance_at({count, subdivision}), double{bound}) << count << ' ' << subdivision;
    }
  }
}

TEST_F(ChooseLevels, ATighterBoundNeedsMore) {
  std::uint32_t last = 0;
  for (const float bound : {0.05f, 0.015f, 0.005f}) {
    const MuscleLevel level = choose(bound).level;
    const std::uint32_t cost = level.section_vertices << level.longitudinal_subdivision;
    EXPECT_GE(cost, last);
    last = cost;
  }
  EXPECT_GT(last, 6u);
}

TEST_F(ChooseLevels, ABoundOutOfReachDoesNotCostEverything) {
  description.attachments[1].position.z = 0.1f;  // the mesh goes on for 15 cm
  const ChosenLevel choice = choose(1e-3f);
  EXPECT_FALSE(choice.kept);
  EXPECT_GT(choice.distance, 0.1f);
  EXPECT_LT(choice.level.section_vertices << choice.level.longitudinal_subdivision, 36u << 5);
}

}  // namespace
}  // namespace fascicle::muscle
