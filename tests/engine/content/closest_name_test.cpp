#include "engine/content/closest_name.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace fascicle {
namespace {

const std::vector<std::string> kBones = {"pelvis", "femur_r", "femur_l", "tibia_r", "tibia_l"};

TEST(ClosestName, FindsLikelySlips) {
  EXPECT_EQ(closest_name("femur_R", kBones), "femur_r");
  EXPECT_EQ(closest_name("femurr", kBones), "femur_r");
  EXPECT_EQ(closest_name("plevis", kBones), "pelvis");
  EXPECT_EQ(closest_name("tibia_ll", kBones), "tibia_l");
}

TEST(ClosestName, GivesNothingForStrangers) {
  EXPECT_EQ(closest_name("scapula", kBones), "");
  EXPECT_EQ(closest_name("", kBones), "");
  EXPECT_EQ(closest_name(std::string(100000, 'x'), kBones), "");
  EXPECT_EQ(closest_name("a", std::vector<std::string>{"b"}), "");
}

TEST(SuggestName, NamesTheClosestOrAll) {
  EXPECT_EQ(suggest_name("Pelvis", kBones, "bones"), "did you mean 'pelvis'?");
  EXPECT_EQ(suggest_name("scapula", kBones, "bones"), "known bones: pelvis, femur_r, femur_l, tibia_r, tibia_l");
  EXPECT_EQ(suggest_name("x", std::vector<std::string>{}, "bones"), "there are no bones");
  const std::vector<std::string> many(20, "name");
  EXPECT_TRUE(suggest_name("zzzzzzzzz", many, "bones").ends_with("and 8 more"));
}

}  // namespace
}  // namespace fascicle
