// Checks, tables and plots of muscles that their coarse hulls posed, of made-up runs.
#include "tools/fascicle_cook/surface_pose_report.hpp"

#include <algorithm>
#include <limits>
#include <sstream>

#include <gmock/gmock.h>
#include <pugixml.hpp>

#include "tests/tools/fascicle_cook/made_up_poses.hpp"
#include "tools/fascicle_cook/surface_checks.hpp"
#include "tools/fascicle_cook/surface_plots.hpp"
#include "tools/fascicle_cook/surface_report.hpp"

namespace fascicle::cook {
namespace {

using testing::HasSubstr;

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

std::vector<std::string> failed(const std::vector<SurfaceCheck>& checks) {
  std::vector<std::string> names;
  for (const SurfaceCheck& check : checks) {
    if (!check.passed) names.push_back(check.what);
  }
  return names;
}

// Some poses twice, and some of them visited again.
SurfaceMuscleRun faultless() {
  SurfaceMuscleRun run = made_up_run({0.1, 0.3, 0.1, 0.2, 0.3});
  for (const Revisit how : {Revisit::kAfterOthers, Revisit::kFirst, Revisit::kIterated}) {
    run.revisits.push_back({4, how, 0.0, 0.0, {1e-2f, 1e-6f}});
  }
  return run;
}

SurfaceRun run_of(SurfaceMuscleRun muscle) {
  SurfaceRun run{.scene = "poses", .simd = "avx2", .options = {}, .step_hz = 60.0f, .muscles = {}};
  run.muscles.push_back(std::move(muscle));
  return run;
}

TEST(CheckPosed, WithoutFaultsEverythingPasses) {
  EXPECT_THAT(failed(check_surface("poses", faultless())), testing::IsEmpty());
  const SurfaceMuscleRun smooth = made_up_run({0.0, 0.1, 0.2, 0.3});
  const std::vector<SurfaceCheck> checks = check_surface("poses", faultless(), &smooth);
  EXPECT_THAT(failed(checks), testing::IsEmpty());
  EXPECT_THAT(surface_checks_table(checks), HasSubstr("3 poses beside dynamics'"));
  // The scene's name is not asked.
  EXPECT_THAT(failed(check_surface("hip-gluteus", faultless())), testing::IsEmpty());
}

TEST(CheckPosed, EveryFaultFailsItsCheck) {
  struct Fault {
    double SurfaceStepFigures::* member;
    double value;
    const char* check;
  };
  using F = SurfaceStepFigures;
  const Fault faults[] = {
      {&F::volume_ratio, 1.002, "|volume ratio - 1| of a pose at every step"},
      {&F::iterations, 11.0, "iterations of a pose at every step"},
      {&F::converged, 0.0, "poses that did not converge (1) at every step"},
      {&F::attachment_error_max, 0.11, "attachment error at every step"},
      {&F::bone_depth_max, 0.6, "deepest point in a bone at every step"},
      {&F::fallbacks, 1.0, "fallbacks so far at every step"},
      {&F::dihedral_mean, 0.1, "3 poses beside dynamics': mean dihedral change to theirs"},
  };
  SurfaceMuscleRun smooth = made_up_run({0.1, 0.2, 0.3});
  for (SurfaceStepFigures& step : smooth.steps) step.dihedral_mean = 0.05;
  for (const Fault& fault : faults) {
    SurfaceMuscleRun run = faultless();
    run.steps[3].*fault.member = fault.value;
    const std::vector<SurfaceCheck> checks = check_surface("poses", run, &smooth);
    ASSERT_THAT(failed(checks), testing::ElementsAre(fault.check));
    for (const SurfaceCheck& check : checks) EXPECT_TRUE(check.passed || check.step == 4u) << check.what;
  }
}

TEST(CheckPosed, AShapeThatDependsOnWhatCameBeforeFails) {
  const auto fails = [](const SurfaceMuscleRun& run, const char* check) {
    const std::vector<std::string> names = failed(check_surface("poses", run));
    return names.size() == 1 && names[0].find(check) != std::string::npos;
  };
  SurfaceMuscleRun run = faultless();
  run.poses[2].shape[1].z += 1e-5f;
  EXPECT_TRUE(fails(run, "poses taken again"));
  for (const std::size_t visit : {0u, 1u}) {
    run = faultless();
    run.revisits[visit].largest = 2e-5;
    EXPECT_TRUE(fails(run, "poses taken again")) << visit;
  }
  run = faultless();
  run.revisits[2].largest = 0.002;
  EXPECT_TRUE(fails(run, "poses iterated further"));
}

// Nothing to look at is no pass.
TEST(CheckPosed, WhatWasNotSeenIsNotPassed) {
  SurfaceMuscleRun run = made_up_run({0.1, 0.2});
  const SurfaceMuscleRun elsewhere = made_up_run({0.5});
  EXPECT_EQ(failed(check_surface("poses", run, &elsewhere)).size(), 3u);
}

TEST(CheckPosed, WhatIsNotANumberFails) {
  SurfaceMuscleRun run = faultless(), smooth = made_up_run({0.1, 0.2, 0.3});
  run.steps[2].volume_ratio = std::numeric_limits<double>::quiet_NaN();
  run.steps[0].dihedral_mean = std::numeric_limits<double>::quiet_NaN();
  run.poses[2].shape[0].x = std::numeric_limits<float>::quiet_NaN();
  for (const SurfaceCheck& check : check_surface("poses", run, &smooth)) EXPECT_FALSE(check.passed) << check.what;
}

TEST(SurfacePoseTable, ARowAPoseByItsAngle) {
  EXPECT_EQ(surface_pose_table(made_up_run({})), "");
  const auto lines = lines_of(surface_pose_table(faultless()));
  ASSERT_EQ(lines.size(), 5u);
  EXPECT_THAT(lines[2], HasSubstr("0.100       1"));
  EXPECT_THAT(lines[3], HasSubstr("0.200       4"));
  EXPECT_THAT(lines[4], HasSubstr("0.300       2"));
  // Of many poses those nearest to tenths.
  std::vector<double> angles;
  for (int i = 100; i >= 0; --i) angles.push_back(0.01 * i + 0.001);
  const auto many = lines_of(surface_pose_table(made_up_run(angles)));
  ASSERT_EQ(many.size(), 13u);
  EXPECT_THAT(many[3], HasSubstr("0.101      91"));
}

TEST(SurfacePoseTable, DynamicsStandBesideTheirPose) {
  SurfaceMuscleRun smooth = made_up_run({0.1, 0.2, 0.4});
  smooth.steps[0].dihedral_mean = 0.04;
  smooth.steps[1].volume_ratio = 0.98765;
  SurfaceMuscleRun run = faultless();
  run.steps[0].dihedral_mean = 0.05;
  const auto lines = lines_of(surface_pose_table(run, &smooth));
  EXPECT_THAT(lines[2], HasSubstr(" 1.250 "));
  EXPECT_THAT(lines[3], HasSubstr("0.98765"));
  EXPECT_EQ(std::count(lines[4].begin(), lines[4].end(), '|'), 0);  // nothing is beside 0.3
}

TEST(SurfaceResiduals, ATableAndALineAnIteration) {
  EXPECT_EQ(surface_residual_table(made_up_run({})), "");
  EXPECT_THAT(surface_residual_table(faultless()), HasSubstr("0.300 rad: 1.0e-02 1.0e-04 1.0e-06 | full mesh: 1.0e-03\n"));
  const auto lines = lines_of(surface_residual_csv(run_of(made_up_run({0.5, 0.1}))));
  ASSERT_EQ(lines.size(), 9u);
  EXPECT_EQ(lines[0], "muscle,step,angle_rad,mesh,iteration,residual");
  EXPECT_EQ(lines[2], "calf & <co>,1,0.5,hull,2,0.0001");
  EXPECT_EQ(lines[8], "calf & <co>,2,0.1,full,1,0.001");
}

TEST(SurfaceResiduals, APlotWithALineAPoseAndTheTolerance) {
  const SurfaceRun run = run_of(faultless());
  const std::vector<SurfacePlot> plots = surface_plots(run, run.muscles[0]);
  const auto found = std::find_if(plots.begin(), plots.end(), [](const auto& plot) { return plot.what == "residuals"; });
  ASSERT_NE(found, plots.end());
  pugi::xml_document document;
  ASSERT_TRUE(document.load_string(found->svg.c_str()));
  int paths = 0;
  for ([[maybe_unused]] const pugi::xml_node path : document.child("svg").children("path")) ++paths;
  EXPECT_EQ(paths, 3 + 1 + 1 + 3);
  EXPECT_THAT(found->svg, HasSubstr(">1e-4<"));
  EXPECT_THAT(found->svg, HasSubstr(">0.30 rad<"));
  EXPECT_THAT(found->svg, HasSubstr(">iteration<"));
}

TEST(SurfaceTable, ShowsTheHullsFiguresOfMusclesThatHaveOne) {
  EXPECT_THAT(surface_table(faultless()), HasSubstr("\niterations "));
  SurfaceMuscleRun bare = faultless();
  bare.hull_vertices = 0;
  EXPECT_THAT(surface_table(bare), testing::Not(HasSubstr("\niterations ")));
  const SurfaceRun run = run_of(faultless());
  EXPECT_THAT(surface_configuration(run, run.muscles[0]), HasSubstr("coarse hull: 300 vertices; at most 10 iterations"));
}

}  // namespace
}  // namespace fascicle::cook
