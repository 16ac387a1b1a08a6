// `fascicle-cook surface` as a program: exit statuses, messages and files.

#include <algorithm>

#include <gmock/gmock.h>

#include "tests/support/test_data.hpp"
#include "tests/tools/fascicle_cook/cook_command.hpp"

namespace fascicle::cook {
namespace {

using testing::HasSubstr;

class SurfaceCommand : public CookCommand {
 protected:
  int run(const std::string& arguments) const { return CookCommand::run("surface " + arguments); }
};

TEST_F(SurfaceCommand, WrongUsage) {
  EXPECT_EQ(run(""), 2);
  EXPECT_EQ(run("box --frames 0"), 2);
  EXPECT_EQ(run("box --solver maybe"), 2);
  EXPECT_THAT(err(), HasSubstr("maybe"));
  EXPECT_EQ(run("box --without gravity"), 2);
  EXPECT_EQ(run("box --picture picture.png"), 2);  // of what beside it?
  EXPECT_THAT(err(), HasSubstr("--beside"));
}

TEST_F(SurfaceCommand, ScenesThatAreNotThereOrHaveNone) {
  EXPECT_EQ(run("bxo"), 1);
  EXPECT_THAT(err(), HasSubstr("bxo"));
  EXPECT_EQ(run("walker --frames 1"), 1);
  EXPECT_THAT(err(), HasSubstr("no character of the scene has a surface muscle"));
}

TEST_F(SurfaceCommand, WithoutTheDataItSaysSo) {
  const std::string command = "env FASCICLE_DATA=/nowhere '" FASCICLE_COOK "' surface box >'" + file("out") + "' 2>'" +
                              file("err") + "'";
  const int status = std::system(command.c_str());
  EXPECT_EQ(WEXITSTATUS(status), 1);
  EXPECT_THAT(err(), HasSubstr("FASCICLE_DATA"));
}

// The plates come together by 0.9 mm a step and reach the box, which ends 10 mm from each, at step 12.
TEST_F(SurfaceCommand, TheBoxBetweenItsPlates) {
  FASCICLE_SKIP_WITHOUT_DATA("pbd/box.vtk");
  // 300 steps are asked about: a shorter run cannot pass.
  EXPECT_EQ(run("box --frames 20 --csv '" + file("box.csv") + "' --plots '" + file("plots") + "'"), 1);
  EXPECT_EQ(err(), "");
  EXPECT_THAT(out(), HasSubstr("box in box: 2648 vertices, 5292 triangles"));
  EXPECT_THAT(out(), HasSubstr("20 steps of 1/60 s"));
  EXPECT_THAT(out(), HasSubstr("PASS  deepest point in a bone at every step"));
  EXPECT_THAT(out(), HasSubstr("the run is shorter"));
  const std::string csv = read("box.csv");
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 21);
  for (const char* what : {"volume", "edges", "dihedral", "bones"}) {
    EXPECT_THAT(read("plots/box-" + std::string(what) + ".svg"), HasSubstr("</svg>")) << what;
  }
  // Nothing moves the box any more: the plate goes into it.
  EXPECT_EQ(run("box --frames 20 --solver off"), 1);
  EXPECT_THAT(out(), HasSubstr("SOLVER OFF"));
  EXPECT_THAT(out(), HasSubstr("FAIL  deepest point in a bone at every step"));
}

TEST_F(SurfaceCommand, FilesThatCannotBeWritten) {
  FASCICLE_SKIP_WITHOUT_DATA("pbd/box.vtk");
  EXPECT_EQ(run("box --frames 1 --csv /dev/null/a.csv --plots /dev/null/b"), 1);
  EXPECT_THAT(err(), HasSubstr("a.csv"));
  EXPECT_THAT(err(), HasSubstr("box-volume.svg"));
}

}  // namespace
}  // namespace fascicle::cook
