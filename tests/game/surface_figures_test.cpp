// The figures of surface muscles in a running scene, and what of them goes into a report.
#include "game/surface_figures.hpp"

#include <cmath>

#include <gmock/gmock.h>
#include <glm/gtc/matrix_transform.hpp>
#include <json/json.h>

#include "engine/animation/skeleton.hpp"
#include "engine/content/triangle_mesh.hpp"
#include "modules/muscle/add_hull.hpp"
#include "modules/muscle/asset/hull/hull_asset.hpp"
#include "modules/muscle/asset/hull/progressive_hull.hpp"
#include "modules/muscle/components/surface_hull.hpp"
#include "modules/muscle/components/surface_muscle.hpp"
#include "modules/muscle/spawn_surface_muscles.hpp"
#include "tests/support/shapes.hpp"

namespace fascicle::game {
namespace {

// A character of two bones, the second one a slab whose top is at z = 0, without muscles of its own.
std::shared_ptr<const muscle::SceneAsset> make_scene() {
  auto skeleton = std::make_shared<Skeleton>();
  skeleton->names = {"ground", "slab"};
  skeleton->parents = {-1, 0};
  skeleton->rest_local.resize(2);
  skeleton->rest_world.assign(2, glm::mat4(1.0f));
  auto character = std::make_shared<muscle::CharacterAsset>();
  character->skeleton = skeleton;
  character->bone_meshes = {
      {1, glm::mat4(1.0f),
       std::make_shared<const TriangleMesh>(test::make_box({-0.1f, -0.1f, -0.05f}, {0.1f, 0.1f, 0.0f}))}};
  auto scene = std::make_shared<muscle::SceneAsset>();
  scene->name = "balls";
  scene->characters.resize(1);
  scene->characters[0].character = character;
  return scene;
}

std::shared_ptr<const muscle::SurfaceAsset> make_ball(const std::vector<std::uint32_t>& attached = {}) {
  muscle::SurfaceMuscleDescription description;
  description.name = "ball";
  description.mesh = test::make_sphere(0.02f, 12, 16, {0.0f, 0.0f, 0.03f});
  if (!attached.empty()) description.attachments = {{1, false, attached}};
  const auto asset = muscle::build_surface_asset(description, 2);
  EXPECT_TRUE(asset.ok()) << to_text(asset.diagnostics());
  return asset ? *asset : nullptr;
}

ecs::Entity spawn(Simulation& simulation, std::shared_ptr<const muscle::SurfaceAsset> asset) {
  const SpawnedCharacter& character = simulation.characters().front();
  const ecs::Entity entity = muscle::spawn_surface_muscle(simulation.world(), character.entity, std::move(asset),
                                                          character.asset->skeleton->rest_world, {});
  simulation.world().get<muscle::SurfaceState>(entity).enabled = false;
  return entity;
}

// As if the solver had done that.
void move_points(Simulation& simulation, ecs::Entity entity, float scale, const glm::vec3& by) {
  auto& state = simulation.world().get<muscle::SurfaceState>(entity);
  for (muscle::SurfacePoint& p : state.points) {
    p.x = scale * p.x + by.x;
    p.y = scale * p.y + by.y;
    p.z = scale * p.z + by.z;
  }
}

Json::Value metrics_of(const std::vector<SurfaceFigures>& figures) {
  Report report;
  report.begin_frame();
  record_surface_figures(figures, report);
  Json::Value root;
  EXPECT_TRUE(Json::Reader().parse(report.to_json("balls", 0), root));
  return root["metrics"];
}

TEST(SurfaceFigures, ASceneWithoutSurfaceMusclesHasNone) {
  Simulation simulation(make_scene(), {.workers = 1});
  SurfaceMeters meters;
  meters.start(simulation);
  simulation.step();
  EXPECT_TRUE(meters.measure(simulation).empty());
  EXPECT_TRUE(metrics_of({}).empty());
}

TEST(SurfaceFigures, NothingIsMeasuredUnlessSomebodyAsks) {
  Simulation simulation(make_scene(), {.workers = 1});
  const ecs::Entity ball = spawn(simulation, make_ball());
  simulation.step();
  EXPECT_FALSE(simulation.world().has<muscle::SurfaceQuality>(ball));
  SurfaceMeters meters;
  meters.start(simulation);
  EXPECT_TRUE(simulation.world().has<muscle::SurfaceQuality>(ball));
}

// Started late, or not at all: the first figures are of the present step all the same.
TEST(SurfaceFigures, AMuscleThatNobodyAnnouncedIsMeasured) {
  Simulation simulation(make_scene(), {.workers = 1});
  const ecs::Entity ball = spawn(simulation, make_ball());
  simulation.step();
  move_points(simulation, ball, 1.1f, glm::vec3(0.0f));
  SurfaceMeters meters;
  const std::vector<SurfaceFigures>& figures = meters.measure(simulation);
  ASSERT_EQ(figures.size(), 1u);
  EXPECT_NEAR(figures[0].quality->volume_ratio, 1.331, 1e-4);
  EXPECT_NEAR(figures[0].quality->edge_ratio_mean, 1.1, 1e-4);
}

TEST(SurfaceFigures, DepthAndAttachmentsAreFoundInTheWorld) {
  Simulation simulation(make_scene(), {.workers = 1});
  const auto asset = make_ball({0});
  const ecs::Entity ball = spawn(simulation, asset);
  simulation.step();
  // The ball's lowest point, 10 mm above the slab, goes 4 mm into it; the attached pole is at the top.
  move_points(simulation, ball, 1.0f, {0.0f, 0.0f, -0.014f});
  SurfaceMeters meters;
  const std::vector<SurfaceFigures>& figures = meters.measure(simulation);
  ASSERT_EQ(figures.size(), 1u);
  EXPECT_NEAR(figures[0].depths.free.depth, 0.004, 1e-5);
  EXPECT_EQ(figures[0].depths.free.bone, 1);
  EXPECT_NEAR(figures[0].attachment_error, 0.014, 1e-6);
  EXPECT_NEAR(figures[0].quality->rest_distance_max, 0.014, 1e-6);
}

TEST(SurfaceFigures, OfSeveralMusclesTheReportHasTheWorst) {
  Simulation simulation(make_scene(), {.workers = 1});
  const ecs::Entity big = spawn(simulation, make_ball()), moved = spawn(simulation, make_ball({0, 1, 2}));
  simulation.step();
  move_points(simulation, big, 0.95f, glm::vec3(0.0f));
  move_points(simulation, moved, 1.0f, {0.0f, 0.0f, -0.013f});
  SurfaceMeters meters;
  const Json::Value metrics = metrics_of(meters.measure(simulation));
  const auto value = [&](const std::string& name) {
    EXPECT_TRUE(metrics.isMember("surface." + name)) << name;
    return metrics["surface." + name][0].asDouble();
  };
  EXPECT_NEAR(value("volume_ratio"), 0.95 * 0.95 * 0.95, 1e-4);
  EXPECT_NEAR(value("edge_ratio_mean"), 0.95, 1e-4);
  EXPECT_NEAR(value("edge_ratio_abs_mean"), 0.05, 1e-4);
  EXPECT_NEAR(value("edge_ratio_max"), 1.0, 1e-4);
  EXPECT_NEAR(value("dihedral_change_mean_rad"), 0.0, 1e-4);
  EXPECT_NEAR(value("bone_depth_max_mm"), 3.0, 1e-2);
  EXPECT_NEAR(value("rest_distance_max_mm"), 13.0, 1e-3);
  EXPECT_NEAR(value("attachment_error_max_mm"), 13.0, 1e-3);
  EXPECT_TRUE(metrics["surface.fibre_length_ratio_mean"][0].isNull());  // there are none
  EXPECT_FALSE(metrics.isMember("surface.fibre_points_outside"));
}

// A ball held at its poles by both bones, posed by its hull, or by dynamics where the game forces that.
ecs::Entity spawn_with_hull(Simulation& simulation) {
  muscle::SurfaceMuscleDescription description;
  description.name = "ball";
  description.mesh = test::make_sphere(0.02f, 12, 16, {0.0f, 0.0f, 0.03f});
  const auto last = static_cast<std::uint32_t>(description.mesh.positions.size()) - 1;
  description.attachments = {{0, true, {0}}, {1, false, {last}}};
  description.action_line = {{.bone = 0, .position = {0.0f, 0.0f, 0.05f}}, {.bone = 1, .position = {0.0f, 0.0f, 0.01f}}};
  description.levels = {{.solver = muscle::SurfaceSolver::kCoarseHull}};
  const auto asset = muscle::build_surface_asset(description, 2);
  const auto hull = muscle::build_progressive_hull(description.mesh, {.vertices = 60});
  if (!asset || !hull) return ecs::kNoEntity;
  const auto reduced = muscle::build_hull_asset(**asset, description, hull->mesh);
  EXPECT_TRUE(reduced.ok()) << to_text(reduced.diagnostics());
  if (!reduced) return ecs::kNoEntity;
  const SpawnedCharacter& character = simulation.characters().front();
  const ecs::Entity entity = muscle::spawn_surface_muscle(simulation.world(), character.entity, *asset,
                                                          character.asset->skeleton->rest_world, {});
  muscle::add_hull(simulation.world(), entity, *reduced);
  return entity;
}

TEST(SurfaceFigures, SayHowTheHullWasSolved) {
  Simulation simulation(make_scene(), {.workers = 1});
  const ecs::Entity first = spawn_with_hull(simulation), second = spawn_with_hull(simulation);
  spawn(simulation, make_ball());
  ASSERT_NE(first, ecs::kNoEntity);
  simulation.step();
  // As if the solver had found that.
  auto& one = simulation.world().get<muscle::SurfaceHull>(first);
  auto& other = simulation.world().get<muscle::SurfaceHull>(second);
  one.pose = {.volume = 1.0, .iterations = 3, .converged = true};
  one.scratch.residuals = {1e-2f, 1e-4f, 1e-6f};
  other.pose = {.volume = 1.0, .iterations = 10, .converged = false};
  other.scratch.residuals = {1e-2f, 0.25f};
  SurfaceMeters meters;
  const std::vector<SurfaceFigures>& figures = meters.measure(simulation);
  ASSERT_EQ(figures.size(), 3u);
  ASSERT_TRUE(figures[0].hull && figures[1].hull);
  EXPECT_FALSE(figures[2].hull);
  EXPECT_TRUE(figures[0].hull->posed && figures[0].hull->converged);
  EXPECT_EQ(figures[0].hull->iterations, 3u);
  EXPECT_NEAR(figures[0].hull->residual, 1e-6, 1e-12);
  // Of two the report has the worse.
  const Json::Value metrics = metrics_of(figures);
  EXPECT_EQ(metrics["surface.iterations"][0].asDouble(), 10.0);
  EXPECT_EQ(metrics["surface.converged"][0].asDouble(), 0.0);
  EXPECT_EQ(metrics["surface.residual"][0].asDouble(), 0.25);
  // One that does not iterate has no residual, which is not a small one.
  other.scratch.residuals.clear();
  EXPECT_TRUE(metrics_of(meters.measure(simulation))["surface.residual"][0].isNull());
}

TEST(SurfaceFigures, ThoseOfTheHullAreNullWhereDynamicsSolve) {
  Simulation simulation(make_scene(), {.workers = 1});
  const ecs::Entity entity = spawn_with_hull(simulation);
  ASSERT_NE(entity, ecs::kNoEntity);
  simulation.world().get<muscle::SurfaceHull>(entity).forced = muscle::SurfaceSolver::kDynamic;
  simulation.step();
  SurfaceMeters meters;
  const std::vector<SurfaceFigures>& figures = meters.measure(simulation);
  ASSERT_EQ(figures.size(), 1u);
  ASSERT_TRUE(figures[0].hull);
  EXPECT_FALSE(figures[0].hull->posed);
  const Json::Value metrics = metrics_of(figures);
  for (const char* name : {"surface.iterations", "surface.converged", "surface.residual"}) {
    ASSERT_TRUE(metrics.isMember(name)) << name;
    EXPECT_TRUE(metrics[name][0].isNull()) << name;
  }
  // Where nothing has a hull nobody asks.
  Simulation without(make_scene(), {.workers = 1});
  spawn(without, make_ball());
  without.step();
  EXPECT_FALSE(metrics_of(SurfaceMeters().measure(without)).isMember("surface.iterations"));
}

}  // namespace
}  // namespace fascicle::game
