// Which sections of a rod lie beside a bone, and what they lose that for.
#include "tools/fascicle_cook/beside_bones.hpp"

#include <gtest/gtest.h>
#include <glm/gtc/matrix_transform.hpp>

#include "modules/muscle/asset/fit/compare_fit.hpp"
#include "tests/support/collision_rods.hpp"
#include "tests/support/shapes.hpp"

namespace fascicle::cook {
namespace {

// A rod of 10 mm radius along z from -0.2 to 0.2 m on bone 0; bone 1 is a box whose top is `gap` below it, `depth` high.
struct RodAndBox {
  std::shared_ptr<const muscle::MuscleAsset> asset;
  std::vector<std::unique_ptr<const Solid>> bones{2};
  std::vector<glm::mat4> rest{2, glm::mat4(1.0f)};
  PosedMuscles muscles;
  std::vector<BesideBone> found;

  explicit RodAndBox(float gap, float depth = 0.05f, float near = 0.005f)
      : asset(test::build_rods({{.from = {0, 0, -0.2f}, .to = {0, 0, 0.2f}, .radius = 0.01f}}, 2)), muscles(asset) {
    const float top = -0.01f - gap;
    bones[1] = std::make_unique<const Solid>(test::make_box({-0.03f, top - depth, -0.11f}, {0.03f, top, 0.11f}));
    found = find_beside_bones(*asset, 0, muscle::rest_surface(*asset, 0).positions, bones, rest, near);
  }
  // How many are left in a pose in which bone 1 is there.
  std::size_t left_after(const glm::vec3& shift) {
    const std::vector<glm::mat4> pose{rest[0], glm::translate(glm::mat4(1.0f), shift)};
    muscles.pose(pose);
    follow_beside_bones(muscles, 0, muscles.vertices(0), bones, pose, found);
    std::size_t left = 0;
    for (const BesideBone& section : found) left += section.stays ? 1 : 0;
    return left;
  }
};

TEST(BesideBones, AreNearAndOutsideAtRest) {
  EXPECT_TRUE(RodAndBox(0.006f).found.empty());   // too far
  EXPECT_TRUE(RodAndBox(-0.004f).found.empty());  // within it, as by an attachment
  const RodAndBox near(0.003f);
  ASSERT_EQ(near.found.size(), 5u);  // of sections 50 mm apart
  for (const BesideBone& section : near.found) {
    EXPECT_EQ(section.bone, 1);
    EXPECT_NEAR(section.distance, 0.003f, 1e-4f);
    EXPECT_NEAR(section.point.x, 0.0f, 1e-5f);
    EXPECT_NEAR(section.point.y, -0.013f, 1e-5f);
  }
}

TEST(BesideBones, StayWhereTheBoneComesCloser) {
  RodAndBox rod(0.003f);
  EXPECT_EQ(rod.left_after({0, 0.005f, 0}), 5u);
  EXPECT_NEAR(rod.found[0].distance, -0.002f, 1e-4f);
  EXPECT_EQ(rod.left_after({0, 0, 0}), 5u);
  EXPECT_NEAR(rod.found[0].distance, -0.002f, 1e-4f);  // the smallest counts
  EXPECT_EQ(rod.left_after({0, 0.02f, 0}), 5u);  // the centre is in the bone: that is what the tag is for
}

TEST(BesideBones, AreLostWhereTheBonesPointSlidesAway) {
  RodAndBox rod(0.003f);
  EXPECT_EQ(rod.left_after({0.009f, 0, 0}), 5u);
  EXPECT_EQ(rod.left_after({0, 0, 0.011f}), 0u);
  EXPECT_EQ(rod.left_after({0, 0, 0}), 0u);  // for good
}

TEST(BesideBones, AreLostWhereTheTagWouldMislead) {
  RodAndBox plate(0.003f, 0.002f);
  EXPECT_EQ(plate.left_after({0, 0.008f, 0}), 5u);
  EXPECT_EQ(plate.left_after({0, 0.018f, 0}), 0u);  // past the centre, which is outside
}

}  // namespace
}  // namespace fascicle::cook
