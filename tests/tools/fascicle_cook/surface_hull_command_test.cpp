// `fascicle-cook surface` as a program, of muscles that their coarse hulls pose.

#include <gmock/gmock.h>

#include "tests/support/test_data.hpp"
#include "tests/tools/fascicle_cook/cook_command.hpp"

namespace fascicle::cook {
namespace {

using testing::HasSubstr;

class SurfaceHullCommand : public CookCommand {
 protected:
  int run(const std::string& arguments) const { return CookCommand::run("surface " + arguments); }
};

TEST_F(SurfaceHullCommand, MusclesThatTheirHullsPose) {
  FASCICLE_SKIP_WITHOUT_DATA("pbd/gluteus_maximus.vtk");
  write("smooth.mot", "a\nversion=1\nnRows=3\nnColumns=2\ninDegrees=no\nendheader\ntime\thip\n0\t-0.7\n"
                      "0.016666666666666666\t-0.78\n0.03333333333333333\t-0.7\n");
  run("hip-hull --frames 2 --beside '" + file("smooth.mot") + "' --csv '" + file("hip.csv") + "' --plots '" +
      file("plots") + "'");
  EXPECT_EQ(err(), "");
  EXPECT_THAT(out(), HasSubstr("coarse hull: 300 vertices"));
  EXPECT_THAT(out(), HasSubstr("1 poses beside dynamics'"));
  EXPECT_THAT(out(), HasSubstr("PASS  attachment error at every step"));
  EXPECT_THAT(read("hip-residuals.csv"), HasSubstr("muscle,step,angle_rad,mesh,iteration,residual"));
  EXPECT_THAT(read("plots/iliacus-residuals.svg"), HasSubstr("</svg>"));
  // Without its solver nothing is what it says.
  EXPECT_EQ(run("hip-hull --frames 1 --solver off"), 1);
  EXPECT_THAT(out(), HasSubstr("FAIL  |volume ratio - 1| of a pose at every step"));
  EXPECT_THAT(out(), HasSubstr("FAIL  poses that did not converge (1) at every step"));
  EXPECT_THAT(out(), testing::Not(HasSubstr("PASS")));
}

// Further than the hip bends in that scene: there the gluteus would be in the femur, did the hull not know of it.
TEST_F(SurfaceHullCommand, BonesAreFeltWhereTheHullAloneWouldGoIn) {
  FASCICLE_SKIP_WITHOUT_DATA("pbd/gluteus_maximus.vtk");
  write("far.mot", "a\nversion=1\nnRows=3\nnColumns=2\ninDegrees=no\nendheader\ntime\thip\n0\t-1.5\n"
                   "0.016666666666666666\t-1.5\n0.03333333333333333\t-1.5\n");
  write("far.scene.json",
        R"({ "version": 1, "name": "far", "requires_data": true, "frames": 1, "characters": [{ "file": ")"
        FASCICLE_SOURCE_DIR R"(/content/characters/hip-hull/hip-hull.character.json",
        "animation": { "motion": "far.mot", "loop": "record" } }] })");
  run("'" + file("far.scene.json") + "'");
  EXPECT_EQ(err(), "");
  EXPECT_THAT(out(), HasSubstr("PASS  deepest point in a bone at every step"));
  EXPECT_THAT(out(), testing::Not(HasSubstr("FAIL  deepest")));
  EXPECT_EQ(run("'" + file("far.scene.json") + "' --without bones"), 1);
  EXPECT_THAT(out(), HasSubstr("FAIL  deepest point in a bone at every step"));
}

}  // namespace
}  // namespace fascicle::cook
