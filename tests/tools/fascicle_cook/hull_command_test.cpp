// `fascicle-cook hull` as a program: exit statuses, messages and files.
#include <algorithm>
#include <filesystem>
#include <string>

#include <gmock/gmock.h>

#include "modules/muscle/content/hull_store.hpp"
#include "tests/tools/fascicle_cook/cook_command.hpp"

namespace fascicle::cook {
namespace {

using testing::HasSubstr;
using testing::Not;

class HullCommand : public CookCommand {
 protected:
  int run(const std::string& arguments) const { return CookCommand::run("hull " + arguments); }

  // A character of one bone with a ball on it.
  std::string make_character(const std::string& solver, const std::string& hull) const {
    write("ball.obj", test::as_obj(test::make_sphere(0.1f, 16, 20)));
    write("ball.character.json", R"({
      "version": 1, "name": "ball",
      "skeleton": { "joints": { "bodies": [ { "name": "root" } ], "coordinates": [],
        "joints": [ { "name": "floor", "parent": "ground", "child": "root" } ] } },
      "surface_muscles": [ { "name": "ball", "mesh": { "file": "ball.obj" }, "solver": ")" + solver + R"(",
        "attachments": [ { "end": "origin", "bone": "root", "beyond": { "normal": [0, 0, -1], "at": 0.09 } } ],
        "action_line": [ { "bone": "root", "at": [0, 0, -0.09] }, { "bone": "root", "at": [0, 0, 0.09] } ],
        "hull": )" + hull + " } ] }");
    return "'" + file("ball.character.json") + "'";
  }
};

TEST_F(HullCommand, WrongUsage) {
  EXPECT_EQ(run(""), 2);
  EXPECT_EQ(run("hip-hull --vertices 3"), 2);
  EXPECT_EQ(run("hip-hull --vertices many"), 2);
  EXPECT_EQ(run("hip-hull --error -1"), 2);
  EXPECT_EQ(run("hip-hull --store --vertices 100"), 2);
  EXPECT_EQ(run("hip-hull --store --muscle iliacus"), 2);
  EXPECT_EQ(run("hip-hull --store --error 1"), 2);
}

TEST_F(HullCommand, WhatIsNotThere) {
  EXPECT_EQ(run("hip-hul"), 1);
  EXPECT_THAT(err(), HasSubstr("did you mean 'hip-hull'?"));
  EXPECT_EQ(run("gait2392"), 1);
  EXPECT_THAT(err(), HasSubstr("it has no surface muscle"));
  const std::string ball = make_character("coarse_hull", "{ \"vertices\": 40 }");
  EXPECT_EQ(run(ball + " --muscle bal"), 1);
  EXPECT_THAT(err(), HasSubstr("did you mean 'ball'?"));
}

TEST_F(HullCommand, MakesWhatIsAskedFor) {
  const std::string ball = make_character("coarse_hull", "{ \"vertices\": 40 }");
  ASSERT_EQ(run(ball), 0) << err();
  EXPECT_THAT(out(), HasSubstr("ball          40        76"));
  ASSERT_EQ(run(ball + " --vertices 30 60 --obj '" + file("objs") + "'"), 0) << err();
  EXPECT_THAT(out(), HasSubstr("ball          30        56"));
  EXPECT_THAT(out(), HasSubstr("ball          60       116"));
  EXPECT_THAT(out(), Not(HasSubstr("NOT")));
  const std::string obj = read("objs/ball-30.obj");
  EXPECT_EQ(std::ranges::count(obj, 'v') + std::ranges::count(obj, 'f'), 30 + 56);
  ASSERT_EQ(run(ball + " --vertices 4 --error 2"), 0) << err();
  EXPECT_THAT(err(), HasSubstr("ball: a hull no further than 2 mm away needs"));
  EXPECT_FALSE(std::filesystem::exists(file("ball.hulls.json"))) << "nothing is stored unless asked for";
}

TEST_F(HullCommand, StoresWhatLoadingWouldMake) {
  const std::string ball = make_character("coarse_hull", "{ \"vertices\": 40 }");
  ASSERT_EQ(run(ball + " --store"), 0) << err();
  const auto store = muscle::read_hull_store(file("ball.hulls.json"));
  ASSERT_TRUE(store.ok()) << to_text(store.diagnostics());
  ASSERT_EQ(store->size(), 1u);
  EXPECT_EQ(store->at("ball").hull.mesh.positions.size(), 40u);
  // The same again, bit for bit.
  const std::string first = read("ball.hulls.json");
  ASSERT_EQ(run(ball + " --store"), 0) << err();
  EXPECT_EQ(read("ball.hulls.json"), first);
}

TEST_F(HullCommand, StoresNothingWhereNothingIsPosedByAHull) {
  const std::string ball = make_character("dynamic", "{ \"vertices\": 40 }");
  EXPECT_EQ(run(ball + " --store"), 1);
  EXPECT_THAT(err(), HasSubstr("no muscle may be posed by a coarse hull"));
  EXPECT_FALSE(std::filesystem::exists(file("ball.hulls.json")));
}

}  // namespace
}  // namespace fascicle::cook
