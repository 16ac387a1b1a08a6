#include "tools/fascicle_cook/surface_report.hpp"

#include <limits>
#include <sstream>

#include <gmock/gmock.h>
#include <pugixml.hpp>

#include "tools/fascicle_cook/surface_checks.hpp"
#include "tools/fascicle_cook/surface_plots.hpp"

namespace fascicle::cook {
namespace {

using testing::HasSubstr;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

std::vector<std::string> split(const std::string& text, char by) {
  std::vector<std::string> parts;
  std::istringstream stream(text);
  for (std::string part; std::getline(stream, part, by);) parts.push_back(part);
  return parts;
}

// A muscle without faults: at rest for so many steps, with so many vertices attached and three fibres.
SurfaceMuscleRun faultless(std::size_t steps, std::size_t attached = 269) {
  auto asset = std::make_shared<muscle::SurfaceAsset>();
  asset->name = "calf & <co>";
  asset->attachments = {{0, true, 5}, {1, false, static_cast<std::uint32_t>(attached)}};
  asset->attached.resize(attached + 5);
  SurfaceMuscleRun run;
  run.asset = asset;
  run.bones = {"pelvis", "femur"};
  run.attached_at_insertion = attached;
  run.steps.resize(steps);
  run.settings.substeps = 7;
  run.fibre_rest = {100.0, 110.0, 120.0};
  run.fibre_ratios.assign(3, std::vector<double>(steps, 1.0));
  return run;
}

SurfaceRun run_of(SurfaceMuscleRun muscle) {
  SurfaceRun run{.scene = "hip-gluteus", .simd = "avx2", .options = {}, .step_hz = 60.0f, .muscles = {}};
  run.options.frames = muscle.steps.size();
  run.muscles.push_back(std::move(muscle));
  return run;
}

std::vector<std::string> failed(const std::vector<SurfaceCheck>& checks) {
  std::vector<std::string> names;
  for (const SurfaceCheck& check : checks) {
    if (!check.passed) names.push_back(check.what);
  }
  return names;
}

TEST(CheckSurface, ARunWithoutStepsPassesNothingThatDependsOnThem) {
  for (const char* scene : {"box", "hip-gluteus", "hip-iliacus", "other"}) {
    for (const SurfaceCheck& check : check_surface(scene, faultless(0))) {
      EXPECT_TRUE(!check.passed || check.what.starts_with("vertices attached")) << scene << ": " << check.what;
    }
  }
}

TEST(CheckSurface, ARunThatEndsEarlyIsNotThere) {
  const std::vector<SurfaceCheck> checks = check_surface("hip-gluteus", faultless(200));
  for (const SurfaceCheck& check : checks) EXPECT_EQ(check.reached, check.what.find("300") == std::string::npos);
  EXPECT_FALSE(all_passed(checks));
  EXPECT_THAT(surface_checks_table(checks), HasSubstr("the run is shorter"));
}

TEST(CheckSurface, WithoutFaultsEverythingPasses) {
  EXPECT_THAT(failed(check_surface("hip-gluteus", faultless(300))), testing::IsEmpty());
  EXPECT_THAT(failed(check_surface("hip-iliacus", faultless(300, 267))), testing::IsEmpty());
  EXPECT_THAT(failed(check_surface("box", faultless(300))), testing::IsEmpty());
  EXPECT_THAT(failed(check_surface("hip-gluteus", faultless(300, 267))),
              testing::ElementsAre("vertices attached at the insertion"));
}

// One fault at a time fails the one check that it is about.
TEST(CheckSurface, EveryFaultFailsItsCheck) {
  struct Fault {
    const char* scene;
    std::size_t step;
    double SurfaceStepFigures::* member;
    double value;
    const char* check;
  };
  using F = SurfaceStepFigures;
  const Fault faults[] = {
      {"hip-gluteus", 57, &F::volume_ratio, 0.994, "|volume ratio - 1| at every step"},
      {"hip-gluteus", 57, &F::fallbacks, 1.0, "fallbacks so far at every step"},
      {"hip-gluteus", 3, &F::attachment_error_max, 0.2, "attachment error at every step"},
      {"hip-gluteus", 280, &F::bone_depth_max, 0.6, "deepest point in a bone at every step"},
      {"hip-gluteus", 100, &F::edge_max, 3.1, "largest edge ratio at step 100"},
      {"hip-gluteus", 100, &F::turned, 1.0, "edges turned inside out at step 100"},
      {"hip-gluteus", 300, &F::edge_max, 1.6, "largest edge ratio at step 300"},
      {"hip-gluteus", 300, &F::edge_abs_mean, 0.011, "mean |edge ratio - 1| at step 300"},
      {"hip-gluteus", 300, &F::dihedral_mean, 0.021, "mean dihedral change at step 300"},
      {"hip-gluteus", 300, &F::fibre_max, 1.006, "worst fibre |length ratio - 1| at step 300"},
      {"hip-gluteus", 300, &F::fibre_min, 0.994, "worst fibre |length ratio - 1| at step 300"},
      {"hip-gluteus", 30, &F::fibres_outside, 1.0, "points of fibres outside of the muscle at every step"},
      {"hip-iliacus", 300, &F::rest_distance_max, 2.1, "furthest vertex from rest at step 300"},
      {"box", 300, &F::edge_mean, 0.994, "|mean edge ratio - 1| at step 300"},
      {"box", 300, &F::edge_max, 1.31, "largest edge ratio at step 300"},
      {"box", 300, &F::dihedral_mean, 0.011, "mean dihedral change at step 300"},
      {"box", 300, &F::volume_ratio, 0.99, "|volume ratio - 1| at step 300"},
      {"other", 9, &F::volume_ratio, 1.006, "|volume ratio - 1| at every step"},
  };
  for (const Fault& fault : faults) {
    SurfaceMuscleRun run = faultless(300, std::string(fault.scene) == "hip-iliacus" ? 267 : 269);
    run.steps[fault.step - 1].*fault.member = fault.value;
    const std::vector<SurfaceCheck> checks = check_surface(fault.scene, run);
    ASSERT_THAT(failed(checks), testing::ElementsAre(fault.check));
    for (const SurfaceCheck& check : checks) {
      EXPECT_TRUE(check.passed || check.step == fault.step) << check.what;
    }
  }
}

TEST(CheckSurface, WhatIsNotANumberPassesNothing) {
  SurfaceMuscleRun run = faultless(300);
  run.steps[56].volume_ratio = kNaN;
  for (const SurfaceCheck& check : check_surface("hip-gluteus", run)) {
    EXPECT_EQ(check.passed, check.what.starts_with("vertices")) << check.what;
  }
}

TEST(CheckSurface, TheBoxMayLoseVolumeWhileThereIsNoRoom) {
  SurfaceMuscleRun run = faultless(300);
  run.steps[99].volume_ratio = 0.4;
  EXPECT_THAT(failed(check_surface("box", run)), testing::IsEmpty());
}

// A shape that came back by itself, without having been a muscle's on the way, is worth nothing; before that it counts.
TEST(CheckSurface, AVoidRunPassesNothingFromThenOn) {
  using F = SurfaceStepFigures;
  const std::vector<std::pair<double F::*, double>> faults = {
      {&F::bone_depth_max, 12.0}, {&F::volume_ratio, 0.8}, {&F::attachment_error_max, 100.0}};
  for (const auto& [member, value] : faults) {
    SurfaceMuscleRun run = faultless(300);
    run.steps[119].*member = value;
    const std::vector<SurfaceCheck> checks = check_surface("hip-gluteus", run);
    for (const SurfaceCheck& check : checks) {
      const bool before = check.what.find("at step 100") != std::string::npos || check.what.starts_with("vertices");
      EXPECT_EQ(check.passed, before) << check.what;
    }
    EXPECT_THAT(surface_checks_table(checks), HasSubstr("void: "));
    EXPECT_THAT(surface_checks_table(checks), HasSubstr("at step 120"));
  }
}

TEST(CompareShapes, IsAPartOfTheMusclesSize) {
  muscle::SurfaceAsset asset = *faultless(0).asset;
  asset.size = 0.2f;
  const std::vector<glm::vec3> one = {{0, 0, 0}, {0.1f, 0, 0}};
  EXPECT_EQ(compare_shapes(asset, one, one).largest, 0.0);
  EXPECT_NEAR(compare_shapes(asset, one, {{0, 0.001f, 0}, {0.1f, 0, 0.003f}}).largest, 0.015, 1e-7);
  EXPECT_NEAR(compare_shapes(asset, one, {{0, 0.001f, 0}, {0.1f, 0, 0.003f}}).mean, 0.01, 1e-7);
  // What cannot be compared is no small difference.
  EXPECT_TRUE(std::isnan(compare_shapes(asset, one, {}).largest));
  EXPECT_TRUE(std::isnan(compare_shapes(asset, one, {{static_cast<float>(kNaN), 0, 0}, {0.1f, 0, 0}}).largest));
  asset.attached.clear();
  EXPECT_NEAR(compare_shapes(asset, one, {{0, 0.001f, 0}, {0.1f, 0.001f, 0}}).largest, 0.0, 1e-7);
}

TEST(SurfaceTable, ShowsTheStepsAndTheWorst) {
  SurfaceMuscleRun muscle = faultless(300);
  muscle.steps[41].volume_ratio = 0.9;
  muscle.steps[99].edge_max = 2.5;
  const auto lines = split(surface_table(muscle), '\n');
  EXPECT_THAT(lines[0], HasSubstr("1        50       100       150       200       250       300"));
  EXPECT_THAT(lines[1], HasSubstr("0.9000  42"));
  const auto largest = std::find_if(lines.begin(), lines.end(), [](const std::string& line) {
    return line.starts_with("edge ratio, largest");
  });
  ASSERT_NE(largest, lines.end());
  EXPECT_THAT(*largest, HasSubstr("2.5000  100"));
  // Shorter runs show their last step, and runs without any have a head only.
  EXPECT_THAT(split(surface_table(faultless(70)), '\n')[0], HasSubstr("50        70"));
  EXPECT_THAT(surface_table(faultless(0)), HasSubstr("volume ratio"));
}

TEST(SurfaceConfiguration, SaysWhatIsSwitchedOff) {
  SurfaceRun run = run_of(faultless(10));
  EXPECT_THAT(surface_configuration(run, run.muscles[0]), HasSubstr("insertion on femur: 269 vertices"));
  EXPECT_THAT(surface_configuration(run, run.muscles[0]), HasSubstr("10 steps of 1/60 s, 7 substeps; density"));
  EXPECT_THAT(surface_configuration(run, run.muscles[0]), testing::Not(HasSubstr("OFF: ")));
  run.options.volume = false;
  EXPECT_THAT(surface_configuration(run, run.muscles[0]), HasSubstr("WITHOUT: volume\n"));
  run.options.solver = SolverSwitch::kOff;
  EXPECT_THAT(surface_configuration(run, run.muscles[0]), HasSubstr("SOLVER OFF"));
}

// What is written comes back by its column's name.
TEST(SurfaceCsv, ALineAStepAndAColumnAFigure) {
  SurfaceMuscleRun muscle = faultless(3);
  muscle.steps[1].volume_ratio = 0.987654321;
  muscle.steps[2].bone_depth_max = 0.25;
  muscle.steps[2].turned = 4;
  const auto lines = split(surface_csv(run_of(muscle)), '\n');
  ASSERT_EQ(lines.size(), 4u);
  const auto columns = split(lines[0], ',');
  const auto value = [&](std::size_t line, const std::string& column) {
    const auto at = std::find(columns.begin(), columns.end(), column) - columns.begin();
    const auto cells = split(lines[line], ',');
    EXPECT_EQ(cells.size(), columns.size());
    return static_cast<std::size_t>(at) < cells.size() ? std::stod(cells[static_cast<std::size_t>(at)]) : kNaN;
  };
  EXPECT_TRUE(lines[2].starts_with("calf & <co>,2,"));
  EXPECT_EQ(value(1, "step"), 1.0);
  EXPECT_EQ(value(2, "volume_ratio"), 0.987654321);
  EXPECT_EQ(value(3, "bone_depth_max_mm"), 0.25);
  EXPECT_EQ(value(3, "turned_edges"), 4.0);
  EXPECT_EQ(value(3, "fibre_length_ratio_mean"), 1.0);
  EXPECT_EQ(split(surface_csv({}), '\n').size(), 1u);
}

int paths_of(const std::string& svg) {
  pugi::xml_document document;
  EXPECT_TRUE(document.load_string(svg.c_str()));
  int count = 0;
  for ([[maybe_unused]] const pugi::xml_node path : document.child("svg").children("path")) ++count;
  return count;
}

TEST(SurfacePlots, AreXmlWithALineAFigureAndAFibre) {
  const SurfaceRun run = run_of(faultless(300));
  const std::vector<SurfacePlot> plots = surface_plots(run, run.muscles[0]);
  ASSERT_EQ(plots.size(), 5u);
  const std::vector<std::pair<std::string, int>> expected = {
      {"volume", 1}, {"edges", 5}, {"dihedral", 1}, {"bones", 3}, {"fibres", 3}};
  for (std::size_t i = 0; i < plots.size(); ++i) {
    EXPECT_EQ(plots[i].what, expected[i].first);
    EXPECT_EQ(paths_of(plots[i].svg), expected[i].second) << plots[i].what;
    EXPECT_THAT(plots[i].svg, testing::Not(HasSubstr("nan")));
    EXPECT_THAT(plots[i].svg, HasSubstr("calf &amp; &lt;co&gt;"));
  }
  SurfaceMuscleRun bare = faultless(300);
  bare.fibre_rest.clear();
  bare.fibre_ratios.clear();
  EXPECT_EQ(surface_plots(run, bare).size(), 4u);
}

}  // namespace
}  // namespace fascicle::cook
