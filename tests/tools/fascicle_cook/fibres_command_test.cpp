// `fascicle-cook fibres` as a program: exit statuses, messages and files.
#include <algorithm>

#include <gmock/gmock.h>

#include "tests/support/test_data.hpp"
#include "tests/tools/fascicle_cook/cook_command.hpp"

namespace fascicle::cook {
namespace {

using testing::HasSubstr;

class FibresCommand : public CookCommand {
 protected:
  int run(const std::string& arguments) const { return CookCommand::run("fibres " + arguments); }
};

TEST_F(FibresCommand, WrongUsage) {
  EXPECT_EQ(run(""), 2);
  EXPECT_EQ(run("box --method magic"), 2);
  EXPECT_THAT(err(), HasSubstr("magic"));
  EXPECT_EQ(run("box --count 0"), 2);
  EXPECT_EQ(run("box --points 1"), 2);
  EXPECT_EQ(run("box --pennation 90"), 2);
}

TEST_F(FibresCommand, WhatIsNotThere) {
  EXPECT_EQ(run("wlaker"), 1);
  EXPECT_THAT(err(), HasSubstr("did you mean 'walker'?"));
  EXPECT_EQ(run("gait2392"), 1);
  EXPECT_THAT(err(), HasSubstr("gait2392"));
}

TEST_F(FibresCommand, MakesMeasuresAndWritesTheHipsFibres) {
  FASCICLE_SKIP_WITHOUT_DATA("pbd/gluteus_maximus.vtk");
  EXPECT_EQ(run("hip-gluteus --muscle gluteus_maxims"), 1);
  EXPECT_THAT(err(), HasSubstr("did you mean 'gluteus_maximus'?"));
  EXPECT_EQ(run("hip-iliacus --method surface"), 1);
  EXPECT_THAT(err(), HasSubstr("it has no fibres on its surface"));

  const std::string files = "--csv '" + file("a.csv") + "' --svg '" + file("a.svg") + "'";
  ASSERT_EQ(run("hip-gluteus --method surface --count 40 --points 6 " + files), 0) << err();
  EXPECT_THAT(out(), HasSubstr("40 of 6 points"));
  EXPECT_THAT(out(), HasSubstr("against 5 surface fibres"));
  const std::string csv = read("a.csv");
  EXPECT_TRUE(csv.starts_with("muscle,fibre,head,length_mm,point,x_m,y_m,z_m\ngluteus_maximus,0,0,"));
  EXPECT_EQ(std::ranges::count(csv, '\n'), 241);
  EXPECT_TRUE(read("a.svg").ends_with("</svg>\n"));

  ASSERT_EQ(run("hip-gluteus --template pennate --pennation 30 --count 20"), 0) << err();
  EXPECT_THAT(out(), HasSubstr("isocontours, pennate, 30 degrees"));
}

TEST_F(FibresCommand, FibresStayInTheMuscleWhileTheHipBends) {
  FASCICLE_SKIP_WITHOUT_DATA("pbd/gluteus_maximus.vtk");
  const int status = run("hip-gluteus --method surface --count 200 --play --every 25");
  if (err().find("without the game's simulation") != std::string::npos) GTEST_SKIP() << err();
  EXPECT_EQ(status, 0) << out() << err();
  EXPECT_THAT(out(), HasSubstr("gluteus_maximus, 300 steps"));
  EXPECT_THAT(out(), HasSubstr("none at 12 steps checked"));
}

}  // namespace
}  // namespace fascicle::cook
