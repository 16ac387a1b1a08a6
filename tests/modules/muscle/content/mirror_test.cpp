#include "modules/muscle/content/mirror.hpp"

#include <gtest/gtest.h>

namespace fascicle::muscle {
namespace {

using Pairs = std::vector<MirrorRule::Pair>;

TEST(MirrorName, NamesWithoutAPartHaveNoImage) {
  EXPECT_EQ(mirror_name("pelvis", Pairs{{"_r", "_l"}}), std::nullopt);
  EXPECT_EQ(mirror_name("", Pairs{{"_r", "_l"}}), std::nullopt);
  EXPECT_EQ(mirror_name("femur_r", Pairs{}), std::nullopt);
}

TEST(MirrorName, WorksBothWays) {
  EXPECT_EQ(mirror_name("femur_r", Pairs{{"_r", "_l"}}), "femur_l");
  EXPECT_EQ(mirror_name("femur_l", Pairs{{"_r", "_l"}}), "femur_r");
}

TEST(MirrorName, TheEndGoesBeforeTheStartAndThatBeforeTheMiddle) {
  EXPECT_EQ(mirror_name("vas_lat_r", Pairs{{"_r", "_l"}}), "vas_lat_l");
  EXPECT_EQ(mirror_name("vas_rot_l", Pairs{{"_r", "_l"}}), "vas_rot_r");
  EXPECT_EQ(mirror_name("r_foot_right", Pairs{{"r_", "l_"}}), "l_foot_right");
  EXPECT_EQ(mirror_name("leg_joint_R_1", Pairs{{"_R_", "_L_"}}), "leg_joint_L_1");
  EXPECT_EQ(mirror_name("a_R_b_R_c", Pairs{{"_R_", "_L_"}}), "a_R_b_L_c");
  EXPECT_EQ(mirror_name("a_L_b_R_c", Pairs{{"_R_", "_L_"}}), "a_L_b_L_c");
}

TEST(MirrorName, TheFirstPairThatFitsCounts) {
  const Pairs pairs{{"Right", "Left"}, {"_r", "_l"}};
  EXPECT_EQ(mirror_name("RightArm_r", pairs), "LeftArm_r");
  EXPECT_EQ(mirror_name("arm_l", pairs), "arm_r");
}

TEST(MirrorName, TwiceGivesTheNameBack) {
  const Pairs pairs{{"_r", "_l"}};
  for (const char* name : {"soleus_r", "rect_fem_l", "per_long_r"}) {
    EXPECT_EQ(mirror_name(*mirror_name(name, pairs), pairs), name);
  }
}

TEST(MirrorPoint, ChangesOneSign) {
  EXPECT_EQ(mirror_point({1, 2, 3}, 0), glm::vec3(-1, 2, 3));
  EXPECT_EQ(mirror_point({1, 2, 3}, 1), glm::vec3(1, -2, 3));
  EXPECT_EQ(mirror_point({1, 2, 3}, 2), glm::vec3(1, 2, -3));
}

}  // namespace
}  // namespace fascicle::muscle
