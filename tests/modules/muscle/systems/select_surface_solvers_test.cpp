// Which solver a surface muscle has: by its size in the picture, with hysteresis, or as a game wants it.
#include "modules/muscle/systems/1_drive/select_surface_solvers.hpp"

#include <limits>

#include <glm/gtc/matrix_transform.hpp>

#include "tests/modules/muscle/systems/hull_world.hpp"

namespace fascicle::muscle {
namespace {

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();

const std::vector<SurfaceLevel> kThree = {
    {.solver = SurfaceSolver::kDynamic, .above_pixels = 400.0f},
    {.solver = SurfaceSolver::kCoarseHull, .above_pixels = 100.0f, .refinements = 3},
    {.solver = SurfaceSolver::kCoarseHull, .above_pixels = 0.0f, .refinements = 0}};

// The ball of 5 cm in a box with this diagonal, seen from so far that it is so many pixels large.
void look(HullWorld& w, float pixels) {
  constexpr float kPixelsPerRadian = 1000.0f;
  const float distance = kPixelsPerRadian * w.asset().size / pixels;
  w.world.set_resource(Viewer{.enabled = true, .eye = {distance, 0.0f, 0.0f}, .pixels_per_radian = kPixelsPerRadian});
}

TEST(ChooseSurfaceLevel, NoLevelsOrNoNumbersAreTheFinest) {
  EXPECT_EQ(choose_surface_level({}, 10.0f, 0), 0u);
  EXPECT_EQ(choose_surface_level({}, kNaN, 7), 0u);
  EXPECT_EQ(choose_surface_level(kThree, kNaN, 2), 0u);
  EXPECT_EQ(choose_surface_level(kThree, kInfinity, 2), 0u);
  EXPECT_EQ(choose_surface_level(kThree, -kInfinity, 0), 2u);
  EXPECT_EQ(choose_surface_level(kThree, -3.0f, 0), 2u);
  EXPECT_EQ(choose_surface_level(std::span(kThree).first(1), 1.0f, 0), 0u);  // the last one has no lower end
}

TEST(ChooseSurfaceLevel, GoesBySizeAndStaysAtABorder) {
  EXPECT_EQ(choose_surface_level(kThree, 400.0f, 0), 0u);
  EXPECT_EQ(choose_surface_level(kThree, 361.0f, 0), 0u);  // a tenth smaller is not enough
  EXPECT_EQ(choose_surface_level(kThree, 359.0f, 0), 1u);
  EXPECT_EQ(choose_surface_level(kThree, 361.0f, 1), 1u);
  EXPECT_EQ(choose_surface_level(kThree, 399.0f, 1), 1u);
  EXPECT_EQ(choose_surface_level(kThree, 400.0f, 1), 0u);
  // Over two levels at once, both ways; what is at the far border stays there.
  EXPECT_EQ(choose_surface_level(kThree, 89.0f, 0), 2u);
  EXPECT_EQ(choose_surface_level(kThree, 91.0f, 0), 1u);
  EXPECT_EQ(choose_surface_level(kThree, 401.0f, 2), 0u);
  EXPECT_EQ(choose_surface_level(kThree, 100.0f, 2), 1u);
  EXPECT_EQ(choose_surface_level(kThree, 99.0f, 2), 2u);
}

TEST(ChooseSurfaceLevel, ASizeThatTremblesAtABorderChangesTheLevelOnce) {
  std::uint32_t level = 0, changes = 0;
  for (int i = 0; i < 1000; ++i) {
    const float pixels = 380.0f + (i % 2 == 0 ? 19.0f : -19.0f) - 0.05f * static_cast<float>(i);
    const std::uint32_t next = choose_surface_level(kThree, pixels, level);
    changes += next != level ? 1 : 0;
    level = next;
  }
  EXPECT_EQ(level, 1u);
  EXPECT_EQ(changes, 1u);
}

TEST(SelectSurfaceSolvers, NobodyLookingIsTheFinest) {
  HullWorld w(still_bones(2));
  w.add_with_hull(ball_with_line(kThree));
  w.world.set_resource(Viewer{.enabled = false, .eye = {1e9f, 0, 0}, .pixels_per_radian = 1.0f});
  w.steps(2);
  EXPECT_EQ(w.hull().solver, SurfaceSolver::kDynamic);
  EXPECT_EQ(w.hull().level, 0u);
  EXPECT_EQ(w.hull().switches, 0u);
}

TEST(SelectSurfaceSolvers, WithoutLevelsItIsSolvedByDynamics) {
  HullWorld w(still_bones(2));
  const SurfaceMuscleDescription description = ball_with_line();
  w.add_with_hull(description);
  auto none = std::make_shared<HullAsset>(*w.hull().asset);
  none->levels.clear();
  add_hull(w.world, w.muscles[0], none);
  w.world.set_resource(Viewer{.enabled = true, .eye = {10.0f, 0, 0}, .pixels_per_radian = 1.0f});
  w.steps(2);
  EXPECT_EQ(w.hull().solver, SurfaceSolver::kDynamic);
  w.world.resource<Viewer>().level = 3;
  w.steps(1);
  EXPECT_EQ(w.hull().solver, SurfaceSolver::kDynamic);
  w.force(SurfaceSolver::kCoarseHull);
  w.steps(1);
  EXPECT_EQ(w.hull().solver, SurfaceSolver::kCoarseHull);
}

TEST(SelectSurfaceSolvers, GoesByTheMusclesSizeInThePicture) {
  HullWorld w(still_bones(2));
  w.add_with_hull(ball_with_line(kThree));
  look(w, 800.0f);
  w.steps(1);
  EXPECT_EQ(w.hull().solver, SurfaceSolver::kDynamic);
  look(w, 200.0f);
  w.steps(1);
  EXPECT_EQ(w.hull().level, 1u);
  EXPECT_EQ(w.hull().solver, SurfaceSolver::kCoarseHull);
  EXPECT_EQ(w.hull().refinements, 3u);
  EXPECT_EQ(w.hull().switches, 1u);
  look(w, 50.0f);
  w.steps(1);
  EXPECT_EQ(w.hull().level, 2u);
  EXPECT_EQ(w.hull().refinements, 0u);
  EXPECT_EQ(w.hull().switches, 1u);  // the same solver, less of it
  // The character comes nearer; its frame bone tells, in the same step.
  w.bones = still_bones(2);
  const glm::vec3 eye = w.world.resource<Viewer>().eye;
  for (glm::mat4& bone : w.bones) bone = glm::translate(glm::mat4(1.0f), eye - glm::vec3(0.1f, 0.0f, 0.0f));
  w.steps(1);
  EXPECT_EQ(w.hull().level, 0u);
  EXPECT_EQ(w.hull().solver, SurfaceSolver::kDynamic);
}

TEST(SelectSurfaceSolvers, BonesThatAreNoneKeepTheLevel) {
  HullWorld w(still_bones(2));
  w.add_with_hull(ball_with_line(kThree));
  look(w, 200.0f);
  w.steps(1);
  ASSERT_EQ(w.hull().level, 1u);
  look(w, 800.0f);
  w.bones[0][3].x = kNaN;
  w.steps(1);
  EXPECT_EQ(w.hull().level, 1u);
  w.bones.clear();
  w.steps(1);
  EXPECT_EQ(w.hull().level, 1u);
  w.bones = still_bones(2);
  w.steps(1);
  EXPECT_EQ(w.hull().level, 0u);
}

TEST(SelectSurfaceSolvers, TheViewersLevelOrAGamesChoiceCounts) {
  HullWorld w(still_bones(2));
  w.add_with_hull(ball_with_line(kThree));
  look(w, 800.0f);
  w.world.resource<Viewer>().level = 1;
  w.steps(1);
  EXPECT_EQ(w.hull().level, 1u);
  w.world.resource<Viewer>().level = 9;
  w.steps(1);
  EXPECT_EQ(w.hull().level, 2u);
  w.force(SurfaceSolver::kDynamic);
  w.steps(1);
  EXPECT_EQ(w.hull().solver, SurfaceSolver::kDynamic);
  // Forced to the hull where the level is dynamic: as the hull's own settings have it.
  w.world.resource<Viewer>().level = 0;
  w.force(SurfaceSolver::kCoarseHull);
  w.hull().settings.refinements = 5;
  w.steps(1);
  EXPECT_EQ(w.hull().solver, SurfaceSolver::kCoarseHull);
  EXPECT_EQ(w.hull().refinements, 5u);
  EXPECT_EQ(w.hull().switches, 3u);
}

}  // namespace
}  // namespace fascicle::muscle
