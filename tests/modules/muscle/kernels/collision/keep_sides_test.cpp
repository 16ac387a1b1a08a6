// Sections on the wrong side of their partner or of a bone: who goes back, by how much, and who stays.
#include "modules/muscle/kernels/collision/keep_sides.hpp"

#include <cmath>
#include <limits>
#include <numbers>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "tests/support/analytic_bones.hpp"
#include "tests/support/collision_rods.hpp"

namespace fascicle::muscle {
namespace {

constexpr float kApart = 0.05f;  // m: between the rods' lines, along x
constexpr float kRadius = 0.02f;

test::Rod rod(float x) { return {.from = {x, 0, -0.1f}, .to = {x, 0, 0.1f}, .radius = kRadius}; }

// A tag on the middle of rod `m` where its surface looks most along x times `side`: lines are straight, so angles count
// from the sections' own u.
SectionTag tag(const MuscleAsset& muscles, std::uint32_t m, float side) {
  const std::uint32_t slot = muscles.slot(m, 4);
  float angle = std::atan2(side * muscles.rest_vx[slot], side * muscles.rest_ux[slot]);
  if (angle < 0.0f) angle += 2.0f * std::numbers::pi_v<float>;
  return {.muscle = m, .fraction = 0.5f, .angle = angle};
}

// Two rods side by side whose middles face each other.
test::CollisionState facing(Yields yields) {
  const auto muscles = test::build_rods({rod(0.0f), rod(kApart)}, 1);
  CollisionDescription description;
  TransversalTag line;
  line.first = tag(*muscles, 0, 1.0f);
  line.second = tag(*muscles, 1, -1.0f);
  line.yields = yields;
  description.transversals.push_back(line);
  return test::CollisionState(test::build_collision(muscles, {nullptr}, description), 1);
}

// How far the first tagged section is past the second, m: negative where they are on their sides.
float past(const test::CollisionState& state) {
  const Transversal& line = state.asset->transversals.at(0);
  return state.work.a[line.section].x - state.work.a[line.other_section].x;
}

void swap(test::CollisionState& state) {
  const Transversal& line = state.asset->transversals.at(0);
  state.work.a[line.section].x += 0.03f;
  state.work.a[line.other_section].x -= 0.03f;
  state.place();
}

TEST(KeepSides, TagsAreFoundWhereTheyFaceEachOther) {
  const test::CollisionState state = facing(Yields::kBoth);
  const Transversal& line = state.asset->transversals.at(0);
  EXPECT_EQ(line.section, state.section(0, 4));
  EXPECT_EQ(line.other_section, state.section(1, 4));
  EXPECT_EQ(line.rest_depth, 0.0f);
  const std::uint32_t first = state.asset->sections[line.section].first_radius + line.vertex;
  const std::uint32_t second = state.asset->sections[line.other_section].first_radius + line.other_vertex;
  EXPECT_GT(state.work.dir_x[first], 0.92f);  // the nearest of 16
  EXPECT_LT(state.work.dir_x[second], -0.92f);
}

TEST(KeepSides, SectionsOnTheirSidesStay) {
  test::CollisionState state = facing(Yields::kBoth);
  const auto before = state.work.a;
  hold_transversals(*state.asset, state.bones, state.work);
  EXPECT_EQ(state.work.a, before);
  // Overlapping by less than the radius is for the contacts.
  state.move(1, {-0.02f, 0, 0});
  state.place();
  const auto moved = state.work.a;
  EXPECT_NEAR(transversal_depth(*state.asset, state.asset->transversals[0], state.bones, state.work), 0.01f, 2.0e-3f);
  hold_transversals(*state.asset, state.bones, state.work);
  EXPECT_EQ(state.work.a, moved);
}

TEST(KeepSides, SwappedSectionsGoBackByWhoYields) {
  for (const Yields yields : {Yields::kBoth, Yields::kFirst, Yields::kSecond}) {
    test::CollisionState state = facing(yields);
    swap(state);
    ASSERT_GT(past(state), 0.0f);
    const Transversal& line = state.asset->transversals[0];
    const glm::vec3 first = state.work.a[line.section], second = state.work.a[line.other_section];
    hold_transversals(*state.asset, state.bones, state.work);
    EXPECT_LT(past(state), -kRadius) << "on their sides again";
    EXPECT_EQ(state.work.a[line.section] == first, yields == Yields::kSecond);
    EXPECT_EQ(state.work.a[line.other_section] == second, yields == Yields::kFirst);
    state.place();
    EXPECT_LT(transversal_depth(*state.asset, line, state.bones, state.work), kRadius);
    // Nobody else moves.
    for (std::uint32_t s = 0; s < state.asset->sections.size(); ++s) {
      if (s == line.section || s == line.other_section) continue;
      EXPECT_EQ(state.work.a[s], state.work.driven[s]);
    }
  }
}

TEST(KeepSides, WhatIsHeldDoesNotYield) {
  test::CollisionState state = facing(Yields::kBoth);
  const Transversal& line = state.asset->transversals[0];
  swap(state);
  state.work.mobility[line.section] = 0.0f;
  const glm::vec3 held = state.work.a[line.section];
  hold_transversals(*state.asset, state.bones, state.work);
  EXPECT_EQ(state.work.a[line.section], held);
  EXPECT_LT(past(state), -kRadius);
  state.work.mobility[line.other_section] = 0.0f;
  swap(state);
  const auto before = state.work.a;
  hold_transversals(*state.asset, state.bones, state.work);
  EXPECT_EQ(state.work.a, before);
}

TEST(KeepSides, TagsThatDoNotFaceEachOtherSayNothing) {
  // Far behind each other along the line: no collision, whatever side they are on.
  test::CollisionState state = facing(Yields::kBoth);
  const Transversal& line = state.asset->transversals[0];
  state.work.a[line.section] += glm::vec3(0.08f, 0.0f, 0.06f);
  state.place();
  EXPECT_EQ(transversal_depth(*state.asset, line, state.bones, state.work), 0.0f);
}

// Bone 1: a box right of the rod.
test::CollisionState beside_bone() {
  const auto muscles = test::build_rods({rod(0.0f)}, 2);
  const auto bone = test::box_bone({0.03f, -0.05f, -0.12f}, {0.05f, 0.05f, 0.12f}, 0.002f);
  CollisionDescription description;
  TransversalTag line;
  line.first = tag(*muscles, 0, 1.0f);
  line.bone = 1;
  description.transversals.push_back(line);
  return test::CollisionState(test::build_collision(muscles, {nullptr, bone}, description), 2);
}

TEST(KeepSides, BonesAreTheOtherEndToo) {
  test::CollisionState state = beside_bone();
  const Transversal& line = state.asset->transversals.at(0);
  EXPECT_NEAR(line.point.x, 0.03f, 1.0e-3f);
  EXPECT_NEAR(line.point.z, 0.0f, 1.0e-3f);
  EXPECT_TRUE(line.first_yields);
  state.work.a[line.section].x += 0.045f;  // beyond the bone's near side by 15 mm and its own radius
  state.place();
  EXPECT_GT(transversal_depth(*state.asset, line, state.bones, state.work), kRadius);
  hold_transversals(*state.asset, state.bones, state.work);
  EXPECT_LT(state.work.a[line.section].x, 0.03f);
  state.place();
  EXPECT_LT(transversal_depth(*state.asset, line, state.bones, state.work), kRadius);
}

TEST(KeepSides, TagsFollowTheirBone) {
  test::CollisionState state = beside_bone();
  const Transversal& line = state.asset->transversals.at(0);
  state.bones[1][3].x = -0.045f;  // the bone has gone through the muscle
  const glm::vec3 before = state.work.a[line.section];
  hold_transversals(*state.asset, state.bones, state.work);
  EXPECT_LT(state.work.a[line.section].x, before.x - 0.01f);
}

TEST(KeepSides, BonesWithoutFieldOrNumbersAreLeftAlone) {
  const auto muscles = test::build_rods({rod(0.0f)}, 2);
  CollisionDescription description;
  TransversalTag line;
  line.first = tag(*muscles, 0, 1.0f);
  line.bone = 1;
  description.transversals.push_back(line);
  EXPECT_TRUE(test::build_collision(muscles, {nullptr, nullptr}, description)->transversals.empty());

  test::CollisionState state = beside_bone();
  state.bones[1][3].x = std::numeric_limits<float>::quiet_NaN();
  const auto before = state.work.a;
  hold_transversals(*state.asset, state.bones, state.work);
  recall_strayed(*state.asset, state.bones, state.work);
  EXPECT_EQ(state.work.a, before);
}

TEST(KeepSides, StrayedSectionsComeBackAndOthersDoNot) {
  test::CollisionState state = beside_bone();
  const std::uint32_t strayed = state.section(0, 3), beside = state.section(0, 5), little = state.section(0, 6);
  state.work.a[strayed].x += 0.08f;   // beyond the bone
  state.work.a[beside].x -= 0.08f;    // as far, but nothing is in the way
  state.work.a[little].x += 0.003f;
  const std::uint32_t first = state.asset->sections[strayed].first_radius;
  state.work.radii[first] *= 0.5f;
  const glm::vec3 kept = state.work.a[beside], kept_little = state.work.a[little];
  recall_strayed(*state.asset, state.bones, state.work);
  EXPECT_EQ(state.work.a[strayed], state.work.driven[strayed]);
  EXPECT_EQ(state.work.radii[first], state.work.wanted[first]);
  EXPECT_EQ(state.work.a[beside], kept);
  EXPECT_EQ(state.work.a[little], kept_little);
}

}  // namespace
}  // namespace fascicle::muscle
