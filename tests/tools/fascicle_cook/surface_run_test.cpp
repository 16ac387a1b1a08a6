// Runs of a small scene whose muscle its coarse hull poses: what is kept of them, poses that are taken again, parts that
// are switched off, and the motion that dynamics go through beside it.
#include "tools/fascicle_cook/surface_run.hpp"

#include <algorithm>
#include <cmath>

#include <gmock/gmock.h>

#include "engine/animation/joint_systems.hpp"
#include "modules/muscle/asset/hull/hull_asset.hpp"
#include "modules/muscle/content/character_asset.hpp"
#include "tests/tools/fascicle_cook/posed_limb.hpp"
#include "tools/fascicle_cook/surface_beside.hpp"
#include "tools/fascicle_cook/surface_poses.hpp"
#include "tools/fascicle_cook/surface_switches.hpp"

namespace fascicle::cook {
namespace {

using testing::HasSubstr;

class RunSurfaces : public testing::Test {
 protected:
  void SetUp() override {
    scene = load_posed_limb(folder, {0.2, 0.05, 0.3, 0.2, 0.1, 0.3});
    ASSERT_TRUE(scene);
  }
  test::ScratchFolder folder;
  std::shared_ptr<const muscle::SceneAsset> scene;
};

TEST_F(RunSurfaces, KeepsThePosesThatTheHullMade) {
  const SurfaceRun run = run_surfaces(scene, {});
  ASSERT_EQ(run.muscles.size(), 1u);
  const SurfaceMuscleRun& muscle = run.muscles[0];
  ASSERT_EQ(muscle.steps.size(), 6u);
  ASSERT_EQ(muscle.poses.size(), 6u);
  EXPECT_GT(muscle.hull_vertices, 10u);
  EXPECT_LE(muscle.hull_vertices, 60u);
  for (const SurfaceStepFigures& step : muscle.steps) EXPECT_EQ(step.posed, 1.0);
  EXPECT_NEAR(pose_angle(*muscle.asset, muscle.poses[2]), 0.3, 1e-5);
  using Steps = std::vector<std::uint64_t>;
  EXPECT_THAT(posed_steps(muscle), testing::ElementsAre(Steps{2}, Steps{5}, Steps{1, 4}, Steps{3, 6}));
}

TEST_F(RunSurfaces, TakesPosesAgainAfterOthersAndAsTheFirst) {
  const SurfaceRun run = run_surfaces(scene, {});
  const SurfaceMuscleRun& muscle = run.muscles[0];
  const auto count = [&](Revisit how) {
    return std::count_if(muscle.revisits.begin(), muscle.revisits.end(), [&](const auto& v) { return v.how == how; });
  };
  EXPECT_EQ(count(Revisit::kAfterOthers), 4);  // the run has just been at its last pose
  EXPECT_EQ(count(Revisit::kFirst), 5);
  EXPECT_EQ(count(Revisit::kIterated), 5);
  const Repeats repeats = compare_repeats(muscle);
  EXPECT_EQ(repeats.count, 2u + 9u);
  EXPECT_LE(repeats.largest, 1e-5);
}

TEST_F(RunSurfaces, DynamicsHaveNoPoses) {
  SurfaceRunOptions options;
  options.forced = muscle::SurfaceSolver::kDynamic;
  const SurfaceRun run = run_surfaces(scene, options);
  EXPECT_EQ(run.muscles[0].steps[3].posed, 0.0);
  EXPECT_THAT(posed_steps(run.muscles[0]), testing::IsEmpty());
  EXPECT_THAT(run.muscles[0].revisits, testing::IsEmpty());
  // They depend on what came before, which a comparison of repeats would have to show.
  EXPECT_GT(compare_shapes(*run.muscles[0].asset, run.muscles[0].poses[2].shape, run.muscles[0].poses[5].shape).largest,
            1e-4);
}

TEST_F(RunSurfaces, ASolverThatIsOffOrFrozenHasNotConverged) {
  for (const SolverSwitch solver : {SolverSwitch::kOff, SolverSwitch::kFrozen}) {
    SurfaceRunOptions options;
    options.solver = solver;
    const SurfaceRun run = run_surfaces(scene, options);
    for (const SurfaceStepFigures& step : run.muscles[0].steps) {
      EXPECT_EQ(step.posed, 1.0);  // it should have been
      EXPECT_EQ(step.converged, 0.0);
    }
    // The bones are where they are all the same.
    EXPECT_NEAR(pose_angle(*run.muscles[0].asset, run.muscles[0].poses[2]), 0.3, 1e-5);
  }
}

// The measure sees what the solver is there for.
TEST_F(RunSurfaces, WithoutTheirVolumePosesLoseIt) {
  const auto worst = [&](bool volume) {
    SurfaceRunOptions options;
    options.volume = volume;
    double off = 0.0;
    const SurfaceRun run = run_surfaces(scene, options);
    for (const SurfaceStepFigures& step : run.muscles[0].steps) off = std::max(off, std::abs(step.volume_ratio - 1.0));
    return off;
  };
  EXPECT_LT(worst(true), 1e-3);
  EXPECT_GT(worst(false), 5e-3);
}

TEST_F(RunSurfaces, HullsAreReducedAnewWithoutTheirParts) {
  EXPECT_EQ(*without_parts(scene, {}), scene);
  SurfaceRunOptions options;
  options.angles = false;
  const auto changed = without_parts(scene, options);
  ASSERT_TRUE(changed.ok()) << to_text(changed.diagnostics());
  const muscle::HullAsset& before = *scene->characters[0].character->hulls[0];
  const muscle::HullAsset& after = *(*changed)->characters[0].character->hulls[0];
  EXPECT_EQ(after.settings.bending, 0.0f);
  EXPECT_EQ(after.settings.direction, before.settings.direction);
  EXPECT_EQ(after.rest, before.rest);
  options.angles = true;
  options.direction = false;
  EXPECT_EQ((*without_parts(scene, options))->characters[0].character->hulls[0]->settings.direction, 0.0f);
  EXPECT_GT(before.settings.bending, 0.0f);  // the scene itself is what it was
}

TEST_F(RunSurfaces, BesideItTheSameCharactersGoThroughAnotherMotion) {
  const auto file = write_knee_motion(folder, "smooth.mot", {0.0, 0.1, 0.2, 0.3, 0.2, 0.1, 0.0});
  const auto beside = scene_beside(*scene, file.string());
  ASSERT_TRUE(beside.ok()) << to_text(beside.diagnostics());
  EXPECT_EQ((*beside)->characters[0].character, scene->characters[0].character);
  EXPECT_NE((*beside)->characters[0].animation.motion, scene->characters[0].animation.motion);
  EXPECT_EQ(steps_to_peak(**beside), 4u);
  game::Simulation simulation(*beside, {.workers = 1});
  const auto& knee = simulation.world().get<CoordinatePose>(simulation.characters()[0].entity).values;
  for (const double angle : {0.0, 0.1, 0.2, 0.3, 0.2}) {
    simulation.step();
    EXPECT_NEAR(knee.at(0), angle, 1e-5);
  }
}

TEST_F(RunSurfaces, PosesAreFoundBesideThatMotions) {
  const auto file = write_knee_motion(folder, "smooth.mot", {0.0, 0.1, 0.2, 0.3, 0.2, 0.1, 0.0});
  SurfaceRunOptions options;
  options.forced = muscle::SurfaceSolver::kDynamic;
  options.keep_poses = true;
  options.frames = 4;
  const SurfaceRun smooth = run_surfaces(*scene_beside(*scene, file.string()), options), run = run_surfaces(scene, {});
  const std::vector<PosePair> pairs = pair_poses(run.muscles[0], smooth.muscles[0]);
  ASSERT_EQ(pairs.size(), 3u);  // 0.05 is not among the motion's
  EXPECT_EQ(pairs[0].step, 5u);
  EXPECT_EQ(pairs[0].beside, 2u);
  EXPECT_EQ(pairs[2].step, 3u);
  EXPECT_EQ(pairs[2].beside, 4u);
  EXPECT_GT(pairs[2].shapes.largest, 0.0);
}

TEST_F(RunSurfaces, AMotionThatCannotBeReadOrUsedIsToldOf) {
  const auto missing = scene_beside(*scene, (folder.path() / "none.mot").string());
  ASSERT_FALSE(missing.ok());
  EXPECT_THAT(to_text(missing.diagnostics()), HasSubstr("none.mot"));
  auto character = std::make_shared<muscle::CharacterAsset>(*scene->characters[0].character);
  character->joints = nullptr;
  muscle::SceneAsset without = *scene;
  without.characters[0].character = character;
  const auto rigid = scene_beside(without, "hip-flexion");
  ASSERT_FALSE(rigid.ok());
  EXPECT_THAT(to_text(rigid.diagnostics()), HasSubstr("no joints"));
}

}  // namespace
}  // namespace fascicle::cook
