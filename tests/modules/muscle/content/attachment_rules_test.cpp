#include "modules/muscle/content/attachment_rules.hpp"

#include <gmock/gmock.h>

#include "engine/content/json_reader.hpp"

namespace fascicle::muscle {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

// 0 pelvis - 1 femur_r - 2 tibia_r - 3 patella_r (a leaf) and 4 foot_r - 5 toes_r; 6 femur_l - 7 tibia_l; 8 prop, a
// root of its own.
Skeleton make_skeleton() {
  Skeleton skeleton;
  skeleton.names = {"pelvis", "femur_r", "tibia_r", "patella_r", "foot_r", "toes_r", "femur_l", "tibia_l", "prop"};
  skeleton.parents = {-1, 0, 1, 2, 2, 4, 0, 6, -1};
  skeleton.rest_local.resize(9);
  skeleton.rest_world.resize(9, glm::mat4(1.0f));
  return skeleton;
}

class AttachmentRules : public testing::Test {
 protected:
  AttachmentRules() : document(*parse_json("{}", "test")) {
    mirror.bones = {{"_r", "_l"}};
    values.hill.optimal_fibre_length = 0.1f;
    values.hill.tendon_slack_length = 0.1f;
  }
  // Points in a row, 10 cm apart, on the given bones.
  bool check(std::initializer_list<std::int32_t> bones) {
    line.clear();
    for (const std::int32_t bone : bones) {
      line.push_back({bone, {0.1f * static_cast<float>(line.size()), 0.0f, 0.0f}, document.root(), document.root()});
    }
    return check_line();
  }
  bool check_line() {
    diagnostics = {};
    const bool fine = check_attachments(line, values, skeleton, mirror, diagnostics);
    EXPECT_EQ(fine, diagnostics.ok());
    return fine;
  }
  JsonDocument document;
  Skeleton skeleton = make_skeleton();
  MirrorRule mirror;
  MuscleDescription values;
  std::vector<PlacedAttachment> line;
  Diagnostics diagnostics;
};

TEST_F(AttachmentRules, BonesBetweenGoThroughTheNearestCommonAncestor) {
  EXPECT_THAT(bones_between(skeleton, 0, 4), ElementsAre(0, 1, 2, 4));
  EXPECT_THAT(bones_between(skeleton, 4, 0), ElementsAre(4, 2, 1, 0));
  EXPECT_THAT(bones_between(skeleton, 7, 1), ElementsAre(7, 6, 0, 1));
  EXPECT_THAT(bones_between(skeleton, 2, 2), ElementsAre(2));
  EXPECT_THAT(bones_between(skeleton, 2, 8), ElementsAre(2, 8));
}

TEST_F(AttachmentRules, AcceptsBonesOnThePathAndNextToIt) {
  EXPECT_TRUE(check({0, 1}));
  EXPECT_TRUE(check({0, 1, 2}));
  EXPECT_TRUE(check({0, 0, 2, 2, 4}));
  EXPECT_TRUE(check({1, 3, 2}));  // the patella, a leaf
  EXPECT_TRUE(check({1, 0, 1}));  // round the pelvis above the topmost bone
  EXPECT_TRUE(check({0, 8}));     // two skeletons: nothing to say without via points
}

TEST_F(AttachmentRules, RefusesBonesOffThePath) {
  EXPECT_FALSE(check({0, 6, 1}));  // a child of the pelvis, but it carries a chain
  EXPECT_FALSE(check({1, 7, 2}));
  EXPECT_FALSE(check({0, 5, 1}));
  EXPECT_FALSE(check({0, 8, 1}));
  ASSERT_EQ(diagnostics.errors.size(), 1u);
  EXPECT_THAT(diagnostics.errors[0].cause, HasSubstr("'prop'"));
  EXPECT_THAT(diagnostics.errors[0].remedy, HasSubstr("pelvis, femur_r"));
}

TEST_F(AttachmentRules, RefusesTheMirrorImageOfABoneOnThePathEvenWhereItIsALeaf) {
  skeleton.names = {"pelvis", "hip_r", "hip_l"};
  skeleton.parents = {-1, 0, 0};
  EXPECT_FALSE(check({0, 2, 1}));
  mirror.bones.clear();
  EXPECT_TRUE(check({0, 2, 1}));
}

TEST_F(AttachmentRules, ReportsEachPairOfCoincidentNeighbours) {
  EXPECT_TRUE(check({0, 0, 1, 1}));
  line[1].rest = line[0].rest;
  line[3].rest = line[2].rest + glm::vec3(5e-6f, 0.0f, 0.0f);
  EXPECT_FALSE(check_line());
  EXPECT_EQ(diagnostics.errors.size(), 2u);
  line[3].rest.x = line[2].rest.x + 1e-4f;
  line[1].rest = line[3].rest;  // the same place, but not neighbours
  EXPECT_TRUE(check_line());
}

TEST_F(AttachmentRules, LimitsTheDistanceOfAViaPointByTheMusclesLength) {
  EXPECT_TRUE(check({0, 0, 1}));
  line[1].rest.y = 0.59f;  // the limit is 2 (0.1 + 2 * 0.1) m
  EXPECT_TRUE(check_line());
  line[1].rest.y = 0.61f;
  EXPECT_FALSE(check_line());
  values.source_length = 0.1f;  // the character is twice the model's size
  EXPECT_TRUE(check_line());
  values.source_length = 0.0f;
  values.hill.optimal_fibre_length = 0.0f;  // nothing known about its length
  EXPECT_TRUE(check_line());
}

}  // namespace
}  // namespace fascicle::muscle
