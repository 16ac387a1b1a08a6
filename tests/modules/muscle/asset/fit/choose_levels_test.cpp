#include "modules/muscle/asset/fit/choose_levels.hpp"

#include <gtest/gtest.h>

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

  // The largest distance that a level leaves, found without the search.
  double distance_at(MuscleLevel level) {
    MuscleDescription at = description;
    at.section_vertices = level.section_vertices;
    at.longitudinal_subdivision = level.longitudinal_subdivision;
    const FitInput input{.description = &at, .mesh = mesh, .areas = {}};
    const auto fitted = fit_muscles({&input, 1}, bones);
    const auto asset = build_muscle_asset({&at, 1}, bones, {&fitted[0].fit, 1});
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
