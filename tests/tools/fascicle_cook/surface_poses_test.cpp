// Poses that a coarse hull made, in made-up runs: which are alike, what depends on what came before, what is beside what.
#include "tools/fascicle_cook/surface_poses.hpp"

#include <cmath>
#include <limits>

#include <gmock/gmock.h>

#include "tests/tools/fascicle_cook/made_up_poses.hpp"

namespace fascicle::cook {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

TEST(PosesApart, IsTheLargestDifferenceOfTheirBones) {
  const SurfacePose rest = made_up_pose(0.0);
  EXPECT_EQ(poses_apart(rest, rest), 0.0);
  EXPECT_NEAR(poses_apart(rest, made_up_pose(0.01)), std::sin(0.01), 1e-7);
  EXPECT_TRUE(std::isinf(poses_apart(rest, {})));
}

TEST(PoseAngle, IsThatOfTheAttachedBoneThatTurnedMost) {
  const SurfaceMuscleRun run = made_up_run({});
  for (const double angle : {0.0, 1e-4, 0.3, 1.0, 3.1}) {
    EXPECT_NEAR(pose_angle(*run.asset, made_up_pose(angle)), angle, 1e-6);
    EXPECT_NEAR(pose_angle(*run.asset, made_up_pose(-angle)), angle, 1e-6);
  }
  EXPECT_EQ(pose_angle(*run.asset, {}), 0.0);
}

TEST(PosedSteps, AreGroupedByPoseAndSortedByAngle) {
  EXPECT_THAT(posed_steps(made_up_run({})), testing::IsEmpty());
  SurfaceMuscleRun run = made_up_run({0.5, 0.1, 0.5, 0.1, 0.1, 0.9});
  using Steps = std::vector<std::uint64_t>;
  EXPECT_THAT(posed_steps(run), testing::ElementsAre(Steps{2, 4, 5}, Steps{1, 3}, Steps{6}));
  // A step that dynamics made is no pose.
  run.steps[2].posed = run.steps[5].posed = 0.0;
  EXPECT_THAT(posed_steps(run), testing::ElementsAre(Steps{2, 4, 5}, Steps{1}));
}

TEST(CompareRepeats, WithoutAnyItTellsNothing) {
  EXPECT_EQ(compare_repeats(made_up_run({})).count, 0u);
  EXPECT_EQ(compare_repeats(made_up_run({0.1, 0.2, 0.3})).count, 0u);
  EXPECT_EQ(compare_repeats(made_up_run({0.1, 0.1, 0.1})).count, 0u);  // it has only stayed
}

TEST(CompareRepeats, FindsTheShapeThatDependsOnWhatCameBefore) {
  SurfaceMuscleRun run = made_up_run({0.1, 0.2, 0.1, 0.3, 0.1, 0.2});
  EXPECT_EQ(compare_repeats(run).count, 3u);
  EXPECT_EQ(compare_repeats(run).largest, 0.0);
  run.poses[4].shape[1].x += 0.002f;  // of a size of 0.2
  EXPECT_NEAR(compare_repeats(run).largest, 0.01, 1e-6);
  EXPECT_EQ(compare_repeats(run).step, 5u);
  run.revisits = {{2, Revisit::kAfterOthers, 0.0}, {6, Revisit::kFirst, 0.02}, {1, Revisit::kIterated, 0.5}};
  EXPECT_EQ(compare_repeats(run).count, 5u);
  EXPECT_EQ(compare_repeats(run).largest, 0.02);
  EXPECT_EQ(compare_repeats(run).step, 6u);
  EXPECT_EQ(compare_iterated(run).count, 1u);
  EXPECT_EQ(compare_iterated(run).largest, 0.5);
  run.poses[2].shape[0].y = static_cast<float>(kNaN);
  EXPECT_TRUE(std::isnan(compare_repeats(run).largest));
}

// The way back of a smooth run passes the same poses: they do not count.
TEST(PairPoses, AreOnTheSmoothRunsWayToItsLargestAngle) {
  const SurfaceMuscleRun smooth = made_up_run({0.0, 0.1, 0.2, 0.3, 0.2, 0.1, 0.0});
  SurfaceMuscleRun posed = made_up_run({0.3, 0.0, 0.2, 0.25, 0.2});
  posed.poses[2].shape[0].x += 0.002f;
  const std::vector<PosePair> pairs = pair_poses(posed, smooth);
  ASSERT_EQ(pairs.size(), 3u);  // none is beside 0.25
  EXPECT_EQ(pairs[0].beside, 1u);
  EXPECT_EQ(pairs[1].beside, 3u);
  EXPECT_EQ(pairs[1].step, 3u);
  EXPECT_NEAR(pairs[1].angle, 0.2, 1e-6);
  EXPECT_NEAR(pairs[1].shapes.largest, 0.01, 1e-6);
  EXPECT_NEAR(pairs[1].shapes.mean, 0.005, 1e-6);
  EXPECT_EQ(pairs[2].beside, 4u);
  EXPECT_EQ(pairs[2].step, 1u);
  EXPECT_THAT(pair_poses(posed, made_up_run({})), testing::IsEmpty());
  EXPECT_THAT(pair_poses(made_up_run({}), smooth), testing::IsEmpty());
}

TEST(BendRatio, CountsNoChangesThatNobodySees) {
  SurfaceMuscleRun posed = made_up_run({0.0}), smooth = made_up_run({0.0});
  const PosePair pair{.angle = 0.0, .step = 1, .beside = 1, .apart = 0.0};
  EXPECT_EQ(bend_ratio(posed, smooth, pair), 0.0);
  posed.steps[0].dihedral_mean = 0.5 * kLeastBend;
  EXPECT_EQ(bend_ratio(posed, smooth, pair), 0.0);
  posed.steps[0].dihedral_mean = 2.0 * kLeastBend;
  EXPECT_NEAR(bend_ratio(posed, smooth, pair), 2.0, 1e-9);
  posed.steps[0].dihedral_mean = 0.06;
  smooth.steps[0].dihedral_mean = 0.04;
  EXPECT_NEAR(bend_ratio(posed, smooth, pair), 1.5, 1e-9);
  smooth.steps[0].dihedral_mean = kNaN;
  EXPECT_TRUE(std::isnan(bend_ratio(posed, smooth, pair)));
}

}  // namespace
}  // namespace fascicle::cook
