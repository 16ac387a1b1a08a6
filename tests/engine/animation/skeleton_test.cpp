#include "engine/animation/skeleton.hpp"

#include <gtest/gtest.h>

#include <numbers>

namespace fascicle {
namespace {

constexpr float kHalf = std::numbers::sqrt2_v<float> / 2.0f;

Skeleton make_arm() {
  Skeleton skeleton;
  skeleton.names = {"upper", "lower", "hand"};
  skeleton.parents = {-1, 0, 1};
  skeleton.rest_local = {{{0, 1, 0}}, {{1, 0, 0}}, {{1, 0, 0}}};
  skeleton.rest_world.resize(3);
  compose(skeleton, skeleton.rest_local, glm::mat4(1.0f), skeleton.rest_world);
  return skeleton;
}

void expect_near(const glm::vec3& a, const glm::vec3& b) {
  EXPECT_NEAR(a.x, b.x, 1e-6f);
  EXPECT_NEAR(a.y, b.y, 1e-6f);
  EXPECT_NEAR(a.z, b.z, 1e-6f);
}

TEST(Skeleton, FindsBonesByName) {
  const Skeleton skeleton = make_arm();
  EXPECT_EQ(skeleton.find("hand"), 2);
  EXPECT_EQ(skeleton.find("foot"), -1);
  EXPECT_EQ(skeleton.find(""), -1);
}

TEST(ToMatrix, ScalesThenTurnsThenMoves) {
  const Trs trs{{1, 2, 3}, glm::quat(kHalf, 0, 0, kHalf), {2, 3, 4}};  // a quarter turn about z
  const glm::mat4 matrix = to_matrix(trs);
  expect_near(glm::vec3(matrix * glm::vec4(1, 0, 0, 1)), {1, 4, 3});
  expect_near(glm::vec3(matrix * glm::vec4(0, 1, 0, 1)), {-2, 2, 3});
  expect_near(glm::vec3(matrix * glm::vec4(0, 0, 1, 1)), {1, 2, 7});
}

TEST(Compose, FollowsTheChain) {
  const Skeleton skeleton = make_arm();
  EXPECT_EQ(glm::vec3(skeleton.rest_world[2][3]), glm::vec3(2, 1, 0));
  std::vector<Trs> pose = skeleton.rest_local;
  pose[1].rotation = glm::quat(kHalf, 0, 0, kHalf);  // bends the elbow by 90 degrees about z
  std::vector<glm::mat4> world(3);
  compose(skeleton, pose, glm::mat4(1.0f), world);
  expect_near(glm::vec3(world[1][3]), {1, 1, 0});
  expect_near(glm::vec3(world[2][3]), {1, 2, 0});
}

TEST(Compose, TheRootMovesAll) {
  const Skeleton skeleton = make_arm();
  const glm::mat4 root = to_matrix(Placement{{10, 0, 0}, glm::quat(0, 0, 1, 0), 0});  // half a turn about y
  std::vector<glm::mat4> world(3);
  compose(skeleton, skeleton.rest_local, root, world);
  expect_near(glm::vec3(world[2][3]), {8, 1, 0});
}

TEST(RestPose, IsThePoseOfTheSkeleton) {
  const auto skeleton = std::make_shared<const Skeleton>(make_arm());
  const LocalPose pose = make_rest_pose(skeleton);
  EXPECT_EQ(pose.skeleton, skeleton);
  ASSERT_EQ(pose.bones.size(), 3u);
  EXPECT_EQ(pose.bones[0].translation, glm::vec3(0, 1, 0));
}

}  // namespace
}  // namespace fascicle
