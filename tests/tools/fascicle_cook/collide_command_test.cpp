// `fascicle-cook collide` as a program: exit statuses, messages, tables and files.

#include <algorithm>
#include <sstream>

#include <gmock/gmock.h>

#include "tests/tools/fascicle_cook/cook_command.hpp"

namespace fascicle::cook {
namespace {

using testing::HasSubstr;
using testing::Not;

class CollideCommand : public CookCommand {
 protected:
  int run(const std::string& arguments) const { return CookCommand::run("collide " + arguments); }
};

TEST_F(CollideCommand, WrongUsage) {
  EXPECT_EQ(run(""), 2);
  EXPECT_EQ(run("walker --every 0"), 2);
  EXPECT_EQ(run("walker --modes sometimes"), 2);
  EXPECT_THAT(err(), HasSubstr("sometimes"));
  EXPECT_EQ(run("walker --hz nan"), 2);
  EXPECT_EQ(run("walker --frames many"), 2);
}

TEST_F(CollideCommand, WhatIsNotThere) {
  EXPECT_EQ(run("wlaker"), 1);
  EXPECT_THAT(err(), HasSubstr("did you mean 'walker'?"));
  EXPECT_EQ(run("walker --clip wolk"), 1);
  EXPECT_THAT(err(), HasSubstr("there is no clip 'wolk'"));
  write("empty.scene.json", R"({ "version": 1, "name": "empty", "characters": [] })");
  EXPECT_EQ(run("'" + file("empty.scene.json") + "'"), 1);
}

TEST_F(CollideCommand, AWalkIsMeasured) {
  ASSERT_EQ(run("walker --modes without --frames 20 --every 10 --pairs 3 --csv '" + file("c.csv") + "'"), 0) << err();
  EXPECT_THAT(out(), HasSubstr("48 muscles"));
  EXPECT_THAT(out(), HasSubstr("\nrest "));
  EXPECT_THAT(out(), HasSubstr("\nwithout "));
  EXPECT_THAT(out(), HasSubstr("2 frames measured"));
  EXPECT_THAT(out(), Not(HasSubstr("NOT FINITE")));
  // A heading, and the steps 10 and 20.
  const std::string csv = read("c.csv");
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 3);
  EXPECT_THAT(csv, HasSubstr("\nwithout,10,"));
  EXPECT_THAT(csv, HasSubstr("\nwithout,20,"));

  ASSERT_EQ(run("walker --modes without --frames 12 --every 12 --json"), 0) << err();
  EXPECT_THAT(out(), HasSubstr("\"mode\": \"without\""));
  EXPECT_THAT(out(), HasSubstr("\"not_finite\": 0"));
}

TEST_F(CollideCommand, AWalkIsDisturbed) {
  ASSERT_EQ(run("walker --extremes --only frame --modes without --every 48"), 0) << err();
  EXPECT_THAT(out(), HasSubstr("frame of 1/15 s"));
  EXPECT_THAT(out(), HasSubstr(" during "));
  EXPECT_THAT(out(), HasSubstr(" after "));
  EXPECT_THAT(out(), HasSubstr("1.60 s"));  // out of bounds to the end
  EXPECT_THAT(out(), Not(HasSubstr("teleport")));
  EXPECT_THAT(out(), Not(HasSubstr("NOT FINITE")));
}

TEST_F(CollideCommand, FilesThatCannotBeWritten) {
  EXPECT_EQ(run("walker --modes without --frames 1 --csv /dev/null/c.csv"), 1);
  EXPECT_THAT(err(), HasSubstr("c.csv"));
}

}  // namespace
}  // namespace fascicle::cook
