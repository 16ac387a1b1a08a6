// Rods against bones that are formulas: how deep, which way out, and nothing where nothing touches.
#include "modules/muscle/kernels/collision/bone_contacts.hpp"

#include <cmath>
#include <limits>

#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

#include "modules/muscle/kernels/collision/contact_rows.hpp"
#include "tests/support/analytic_bones.hpp"
#include "tests/support/collision_rods.hpp"

namespace fascicle::muscle {
namespace {

constexpr float kReach = 0.0025f;  // m
constexpr float kSagitta = 0.02f * 0.0013f;  // m: of 64 vertices on a circle of 20 mm, and rounding

test::Rod rod_along_z(float y = 0.0f) {
  return {.from = {0, y, -0.1f}, .to = {0, y, 0.1f}, .section_vertices = 64};
}

// Bone 1 fills everything below y = -30 mm; the rod of bone 0 lies 10 mm above.
test::CollisionState over_ground(const CollisionDescription& description = {}, float y = 0.0f) {
  const auto muscles = test::build_rods({rod_along_z(y)}, 2);
  const auto ground = test::box_bone({-0.08f, -0.1f, -0.15f}, {0.08f, -0.03f, 0.15f});
  return test::CollisionState(test::build_collision(muscles, {nullptr, ground}, description), 2);
}

TEST(BoneContacts, NothingWhereNothingTouches) {
  test::CollisionState state = over_ground();
  state.find();
  EXPECT_TRUE(state.work.contacts.empty());
  state.move(0, {0, 5, 0});
  state.find();
  EXPECT_TRUE(state.work.contacts.empty());
}

TEST(BoneContacts, BonesThatAreNotFiniteTouchNothing) {
  for (const float bad : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
    for (const int column : {0, 3}) {
      test::CollisionState state = over_ground();
      state.move(0, {0, -0.015f, 0});
      state.bones[1][column].y = bad;
      state.find();
      for (const Contact& contact : state.work.contacts) {
        EXPECT_TRUE(std::isfinite(contact.found));
        EXPECT_TRUE(std::isfinite(contact.base));
      }
    }
  }
}

TEST(BoneContacts, PlaneIsAsDeepAsItIsPressedIn) {
  test::CollisionState state = over_ground();
  for (const float depth : {0.001f, 0.005f, 0.012f}) {
    state.move(0, {0, -0.010f - depth, 0});
    state.find();
    EXPECT_NEAR(state.deepest(), depth, kSagitta);
    for (const Contact& contact : state.work.contacts) {
      EXPECT_EQ(contact.bone, 0);  // the first that has a field
      EXPECT_NEAR(contact.normal.y, 1.0f, 1.0e-3f);
      EXPECT_NEAR(contact.found, contact.place.y + 0.03f, 1.0e-5f);
      EXPECT_NEAR(contact_value(contact, state.work), contact.found, 1.0e-6f);
      EXPECT_LT(glm::distance(sample_place(contact, state.work), contact.place), 1.0e-6f);
      EXPECT_LE(contact.found, kReach);
    }
    state.move(0, {0, 0.010f + depth, 0});
  }
}

TEST(BoneContacts, MarginIsKept) {
  test::CollisionState state = over_ground();
  state.move(0, {0, -0.012f, 0});
  CollisionSettings settings;
  settings.bone_margin = 0.003f;
  state.find(settings);
  EXPECT_NEAR(state.deepest(), 0.005f, kSagitta);
}

TEST(BoneContacts, MovedAndTurnedBonesAreMetWhereTheyAre) {
  test::CollisionState state = over_ground();
  const glm::mat4 motion = glm::rotate(glm::translate(glm::mat4(1.0f), {0.3f, -2.0f, 0.7f}), 2.1f,
                                       glm::normalize(glm::vec3(1, -3, 2)));
  for (std::size_t s = 0; s < state.asset->sections.size(); ++s) {
    state.work.a[s] = glm::vec3(motion * glm::vec4(state.work.a[s] - glm::vec3(0, 0.014f, 0), 1.0f));
    for (glm::vec3* axis : {&state.work.u[s], &state.work.v[s], &state.work.t[s]}) *axis = glm::mat3(motion) * *axis;
  }
  for (glm::mat4& bone : state.bones) bone = motion;
  state.find();
  EXPECT_NEAR(state.deepest(), 0.004f, 2.0f * kSagitta);
  for (const Contact& contact : state.work.contacts) {
    EXPECT_GT(glm::dot(contact.normal, glm::mat3(motion) * glm::vec3(0, 1, 0)), 0.999f);
  }
}

TEST(BoneContacts, SphereSendsSamplesOutAlongItsRadii) {
  const auto muscles = test::build_rods({rod_along_z()}, 2);
  test::CollisionState state(test::build_collision(muscles, {nullptr, test::sphere_bone(0.015f)}), 2);
  // At rest the sphere is within the rod: what is deep there is allowed. Bring it in from the side.
  state.bones[1][3] = glm::vec4(0.031f, 0.0f, 0.002f, 1.0f);
  state.find();
  int deep = 0;
  for (const Contact& contact : state.work.contacts) {
    if (contact.row == kCentreRow) continue;
    const glm::vec3 from_centre = contact.place - glm::vec3(state.bones[1][3]);
    EXPECT_NEAR(contact.found - contact.allowed, glm::length(from_centre) - 0.015f, 2.0e-4f);
    EXPECT_GT(glm::dot(contact.normal, glm::normalize(from_centre)), 0.99f);
    deep += contact.found < 0.0f ? 1 : 0;
  }
  EXPECT_GT(deep, 0);
}

TEST(BoneContacts, WhatIsInABoneAtRestMayStayAsDeep) {
  test::CollisionState state = over_ground({}, -0.013f);  // 3 mm deep
  state.find();
  EXPECT_FALSE(state.work.contacts.empty());
  EXPECT_LE(state.deepest(), 0.0f);
  state.move(0, {0, -0.002f, 0});
  state.find();
  EXPECT_NEAR(state.deepest(), 0.002f, 3.0e-4f);
}

TEST(BoneContacts, SampleThatCameThroughGoesBackTheWayItCame) {
  // A plate of 4 mm; the rod's lower side is 3.5 mm through it, nearer to the plate's far side.
  const auto plate = test::box_bone({-0.08f, -0.034f, -0.15f}, {0.08f, -0.030f, 0.15f}, 0.001f);
  test::CollisionState state(test::build_collision(test::build_rods({rod_along_z()}, 2), {nullptr, plate}), 2);
  state.move(0, {0, -0.0135f, 0});
  state.find();
  int lowest = 0;
  for (const Contact& contact : state.work.contacts) {
    if (contact.row == kCentreRow || contact.place.y > -0.0331f) continue;
    EXPECT_GT(contact.normal.y, 0.9f) << contact.place.y;
    ++lowest;
  }
  EXPECT_GT(lowest, 0);
}

TEST(BoneContacts, CentreInABoneComesOutAsAWhole) {
  test::CollisionState state = over_ground();
  state.move(0, {0, -0.034f, 0});  // centres 4 mm deep
  state.find();
  std::size_t centres = 0;
  for (const Contact& contact : state.work.contacts) {
    if (contact.row != kCentreRow) continue;
    ++centres;
    EXPECT_NEAR(contact.found, -0.004f, 1.0e-4f);
    EXPECT_GT(contact.normal.y, 0.99f);
    EXPECT_NEAR(contact_value(contact, state.work), contact.found, 1.0e-6f);
    EXPECT_FALSE(state.asset->sections[contact.section].end);
  }
  EXPECT_EQ(centres, state.asset->sections.size() - 2);
}

TEST(BoneContacts, EndsDoNotCount) {
  // Only the outer half of the first segment is pressed in: attachments grow out of bones.
  const auto block = test::box_bone({-0.05f, -0.05f, -0.15f}, {0.05f, 0.05f, -0.089f});
  const auto muscles = test::build_rods({rod_along_z(0.2f)}, 2);
  test::CollisionState state(test::build_collision(muscles, {nullptr, block}), 2);
  state.move(0, {0, -0.2f, 0});
  state.find();
  for (const Contact& contact : state.work.contacts) EXPECT_GT(contact.found, 0.0f) << contact.place.z;
}

TEST(BoneContacts, IgnoredPairsAndTagsLeaveBonesOut) {
  CollisionDescription ignoring;
  ignoring.ignored.push_back({.muscle = 0, .bone = 1, .where = {}});
  test::CollisionState ignored = over_ground(ignoring);
  ignored.move(0, {0, -0.015f, 0});
  ignored.find();
  EXPECT_TRUE(ignored.work.contacts.empty());

  CollisionDescription tagging;  // the first half must stay out of bone 0 alone, which has no field
  tagging.bone_tags.push_back({.muscle = 0, .from = 0.0f, .to = 0.5f, .bones = {0}, .where = {}});
  test::CollisionState tagged = over_ground(tagging);
  tagged.move(0, {0, -0.015f, 0});
  tagged.find();
  EXPECT_FALSE(tagged.work.contacts.empty());
  for (const Contact& contact : tagged.work.contacts) EXPECT_GT(contact.place.z, 0.0f);
}

TEST(BoneContacts, RefreshedContactsKnowTheirNewPlace) {
  test::CollisionState state = over_ground();
  state.move(0, {0, -0.015f, 0});
  state.find();
  state.move(0, {0, 0.003f, 0});
  refresh_bone_contacts(*state.asset, state.bones, 0.0f, state.work);
  for (const Contact& contact : state.work.contacts) {
    EXPECT_NEAR(contact_value(contact, state.work), sample_place(contact, state.work).y + 0.03f, 1.0e-5f);
  }
}

TEST(BoneContacts, ValueFollowsCentresAndRadii) {
  // C is linear: what it says of small changes is what the samples' new places say.
  test::CollisionState state = over_ground();
  state.move(0, {0, -0.015f, 0});
  state.find();
  const std::vector<Contact> contacts = state.work.contacts;
  ASSERT_FALSE(contacts.empty());
  for (std::size_t s = 0; s < state.asset->sections.size(); ++s) {
    const float turn = static_cast<float>(s);
    state.work.a[s] += 0.001f * glm::vec3(std::sin(3.0f * turn), std::cos(turn), 0.3f);
  }
  for (std::size_t i = 0; i < state.asset->muscles->rest_radii.size(); ++i) {
    state.work.radii[i] += 0.001f * std::sin(static_cast<float>(i));
  }
  state.place();
  for (const Contact& contact : contacts) {
    if (contact.row == kCentreRow) continue;
    const std::uint32_t s = state.asset->rows[contact.row].first_sample + contact.sample;
    const glm::vec3 now(state.work.sample_x[s], state.work.sample_y[s], state.work.sample_z[s]);
    EXPECT_NEAR(contact_value(contact, state.work), contact.found + glm::dot(contact.normal, now - contact.place),
                2.0e-6f);
  }
}

}  // namespace
}  // namespace fascicle::muscle
