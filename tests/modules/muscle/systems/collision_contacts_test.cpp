// What games read: who touches whom, since when, how deep.
#include "modules/muscle/systems/4_solve/report_contacts.hpp"

#include <algorithm>
#include <tuple>

#include "tests/modules/muscle/systems/collision_world.hpp"

namespace fascicle::muscle {
namespace {

using Pair = std::tuple<std::uint32_t, std::int32_t, std::uint32_t>;

Pair pair_of(const MuscleContact& contact) { return {contact.muscle, contact.bone, contact.other}; }

std::vector<Pair> pairs_of(const std::vector<MuscleContact>& contacts) {
  std::vector<Pair> pairs;
  for (const MuscleContact& contact : contacts) pairs.push_back(pair_of(contact));
  return pairs;
}

bool holds(const std::vector<MuscleContact>& contacts, const Pair& pair) {
  const std::vector<Pair> pairs = pairs_of(contacts);
  return std::find(pairs.begin(), pairs.end(), pair) != pairs.end();
}

// now = what was there, and what began, less what ended.
void expect_consistent(const std::vector<Pair>& before, const MuscleContacts& contacts) {
  std::vector<Pair> expected = before;
  for (const Pair& ended : pairs_of(contacts.ended)) {
    EXPECT_EQ(std::erase(expected, ended), 1u);
  }
  for (const Pair& began : pairs_of(contacts.began)) {
    EXPECT_EQ(std::count(expected.begin(), expected.end(), began), 0);
    expected.push_back(began);
  }
  std::vector<Pair> now = pairs_of(contacts.now);
  std::sort(expected.begin(), expected.end());
  std::sort(now.begin(), now.end());
  EXPECT_EQ(now, expected);
  EXPECT_EQ(std::adjacent_find(now.begin(), now.end()), now.end()) << "a pair is listed once";
}

TEST(CollisionContacts, PressAndReleaseOfABone) {
  RodWorld w({rod_along_z()}, ground());
  const Pair touch{0, 1, 0};
  int began = 0, ended = 0;
  const auto follow = [&](float height) {
    const std::vector<Pair> before = pairs_of(w.contacts().now);
    w.place_bone(1, glm::translate(glm::mat4(1.0f), {0, height, 0}));
    w.step();
    expect_consistent(before, w.contacts());
    began += holds(w.contacts().began, touch) ? 1 : 0;
    ended += holds(w.contacts().ended, touch) ? 1 : 0;
  };
  for (int i = 0; i <= 20; ++i) follow(0.0008f * static_cast<float>(i));
  EXPECT_EQ(began, 1);
  EXPECT_EQ(ended, 0);
  for (int i = 0; i < 100; ++i) follow(0.016f);
  EXPECT_EQ(began, 1);
  EXPECT_EQ(ended, 0);
  ASSERT_EQ(w.contacts().now.size(), 1u);
  const MuscleContact contact = w.contacts().now[0];
  EXPECT_EQ(pair_of(contact), touch);
  EXPECT_GT(contact.normal.y, 0.99f);
  EXPECT_NEAR(contact.place.y, -0.014f, 0.001f);
  EXPECT_GT(contact.points, 5u);
  EXPECT_LT(contact.left, 3.0e-4f);
  for (int i = 20; i >= 0; --i) follow(0.0008f * static_cast<float>(i));
  for (int i = 0; i < 30; ++i) follow(0.0f);
  EXPECT_EQ(began, 1);
  EXPECT_EQ(ended, 1);
  EXPECT_TRUE(w.contacts().now.empty());
  EXPECT_TRUE(w.contacts().ended.empty());
}

TEST(CollisionContacts, DepthIsWhatTheStepPressedIn) {
  RodWorld w({rod_along_z()}, ground());
  w.step();
  w.place_bone(1, glm::translate(glm::mat4(1.0f), {0, 0.013f, 0}));  // 3 mm at once
  w.step();
  ASSERT_EQ(w.contacts().now.size(), 1u);
  EXPECT_NEAR(w.contacts().now[0].depth, 0.003f, 5.0e-4f);
  EXPECT_LT(w.contacts().now[0].left, w.contacts().now[0].depth);
  EXPECT_GE(w.collision().depth[0], 0.0f);
  EXPECT_GT(w.collision().cost[0], 0.0f);
  EXPECT_GT(w.collision().contact_count, 0u);
}

TEST(CollisionContacts, MusclesAreListedOnceWithTheLowerIndexFirst) {
  RodWorld w(crossing_rods(), {nullptr, nullptr});
  w.step();
  w.place_bone(1, glm::translate(glm::mat4(1.0f), {0, -0.013f, 0}));
  w.step();
  ASSERT_EQ(w.contacts().now.size(), 1u);
  const MuscleContact& contact = w.contacts().now[0];
  EXPECT_EQ(pair_of(contact), Pair(0, -1, 1));
  EXPECT_NEAR(contact.depth, 0.003f, 8.0e-4f);
  EXPECT_LT(contact.normal.y, -0.9f);  // out of the upper one
  EXPECT_LT(glm::distance(contact.place, glm::vec3(0, 0.0185f, 0)), 0.01f);
  EXPECT_EQ(pairs_of(w.contacts().began), pairs_of(w.contacts().now));
  w.step();
  EXPECT_TRUE(w.contacts().began.empty());
  EXPECT_EQ(w.contacts().now.size(), 1u);
}

TEST(CollisionContacts, BonesComeBeforeMusclesInOrder) {
  // Three rods in a row on the ground, pressed together; the middle one touches both.
  test::BoneFields fields = ground();
  fields.push_back(nullptr);
  fields.push_back(nullptr);
  std::vector<test::Rod> rods = {rod_along_z(0.0f), rod_along_z(0.05f), rod_along_z(-0.05f)};
  rods[1].from_bone = rods[1].to_bone = 2;
  rods[2].from_bone = rods[2].to_bone = 3;
  RodWorld w(rods, fields);
  w.bring_bone(2, {-0.013f, 0, 0});
  w.bring_bone(3, {0.013f, 0, 0});
  w.bring_bone(1, {0, 0.013f, 0});
  const std::vector<Pair> expected = {{0, 1, 0}, {0, -1, 1}, {0, -1, 2}, {1, 1, 0}, {2, 1, 0}};
  EXPECT_EQ(pairs_of(w.contacts().now), expected);
}

TEST(CollisionContacts, TeleportedCharacterKeepsItsContacts) {
  RodWorld w(crossing_rods(), {nullptr, nullptr});
  w.bring_bone(1, {0, -0.013f, 0});
  w.steps(10);
  const std::vector<Pair> before = pairs_of(w.contacts().now);
  ASSERT_EQ(before.size(), 1u);
  const glm::mat4 motion = glm::rotate(glm::translate(glm::mat4(1.0f), {12, 5, -7}), 1.0f, {0, 1, 0});
  for (glm::mat4& bone : w.bones) bone = motion * bone;
  w.pose(w.character, w.bones);
  ++w.world.get<BoneMatrices>(w.character).teleport_count;
  const float deformed = w.deformation();
  w.step();
  EXPECT_EQ(pairs_of(w.contacts().now), before);
  EXPECT_TRUE(w.contacts().began.empty());
  EXPECT_TRUE(w.contacts().ended.empty());
  EXPECT_NEAR(w.deformation(), deformed, 2.0e-4f);
}

}  // namespace
}  // namespace fascicle::muscle
