#include "game/surface_stats.hpp"

#include <filesystem>

#include <gmock/gmock.h>

#include "modules/muscle/components/surface_hull.hpp"
#include "modules/muscle/components/surface_muscle.hpp"
#include "modules/muscle/muscle.hpp"

namespace fascicle::game {
namespace {

std::shared_ptr<const muscle::SceneAsset> walker() {
  const auto scene =
      muscle::load_scene(std::filesystem::path(FASCICLE_SOURCE_DIR) / "content" / "scenes" / "walker.scene.json");
  EXPECT_TRUE(scene.ok()) << to_text(scene.diagnostics());
  return *scene;
}

// A muscle of ten litres with the components' numbers put in by hand.
ecs::Entity add_muscle(Simulation& simulation, const char* name) {
  auto asset = std::make_shared<muscle::SurfaceAsset>();
  asset->name = name;
  asset->vertex_count = 77;
  asset->volume = 0.01;
  muscle::SurfaceMuscle surface;
  surface.asset = std::move(asset);
  surface.character = simulation.characters()[0].entity;
  const ecs::Entity entity = simulation.world().create();
  simulation.world().add(entity, std::move(surface));
  simulation.world().add(entity, muscle::SurfaceState{});
  simulation.world().add(entity, muscle::SurfaceContacts{});
  return entity;
}

TEST(SurfaceStats, WithoutASurfaceMuscleThereIsNothing) {
  Simulation simulation(walker(), {.workers = 1, .skin_meshes = false});
  SurfaceStats stats;
  stats.record(simulation);
  EXPECT_FALSE(stats.any());
  EXPECT_EQ(stats.to_table(), "");
}

TEST(SurfaceStats, StepsAddUpAndExtremesStay) {
  Simulation simulation(walker(), {.workers = 1, .skin_meshes = false});
  const ecs::Entity first = add_muscle(simulation, "first");
  add_muscle(simulation, "second");
  SurfaceStats stats;
  for (const double volume : {0.0098, 0.0101}) {
    auto& state = simulation.world().get<muscle::SurfaceState>(first);
    state.volume = volume;
    state.fallbacks += 1;
    auto& contacts = simulation.world().get<muscle::SurfaceContacts>(first).now;
    contacts = {{1, 4, volume < 0.01 ? 0.002f : 0.001f}, {2, 1, 0.0005f}};
    stats.record(simulation);
  }
  EXPECT_TRUE(stats.any());
  const std::string table = stats.to_table();
  EXPECT_THAT(table, testing::ContainsRegex("walker 1 +first +77 +5\\.0 +2\\.000 +98\\.000 \\.\\. 101\\.000 +2\n"));
  EXPECT_THAT(table, testing::ContainsRegex("walker 1 +second +77 +0\\.0 "));
}

TEST(SurfaceStats, StepsAndIterationsOfCoarseHullsAreCounted) {
  Simulation simulation(walker(), {.workers = 1, .skin_meshes = false});
  const ecs::Entity posed = add_muscle(simulation, "posed");
  add_muscle(simulation, "solved");
  simulation.world().add(posed, muscle::SurfaceHull{});
  SurfaceStats stats;
  for (const std::uint32_t iterations : {0u, 5u, 8u}) {
    auto& hull = simulation.world().get<muscle::SurfaceHull>(posed);
    hull.solver = iterations > 0 ? muscle::SurfaceSolver::kCoarseHull : muscle::SurfaceSolver::kDynamic;
    hull.pose.iterations = iterations;
    stats.record(simulation);
    EXPECT_EQ(stats.to_table().find("iterations") != std::string::npos, iterations > 0);
  }
  EXPECT_THAT(stats.to_table(), testing::ContainsRegex("posed .* 0 +2 +6\\.5\n"));
  EXPECT_THAT(stats.to_table(), testing::ContainsRegex("solved .* 0 +0 +0\\.0\n"));
}

TEST(SurfaceStats, OnesSpawnedAnewBeginAnew) {
  Simulation simulation(walker(), {.workers = 1, .skin_meshes = false});
  const ecs::Entity old = add_muscle(simulation, "old");
  simulation.world().get<muscle::SurfaceState>(old).volume = 0.02;
  SurfaceStats stats;
  stats.record(simulation);
  simulation.world().destroy(old);
  const ecs::Entity again = add_muscle(simulation, "again");
  simulation.world().get<muscle::SurfaceState>(again).volume = 0.01;
  stats.record(simulation);
  EXPECT_THAT(stats.to_table(), testing::Not(testing::HasSubstr("old")));
  EXPECT_THAT(stats.to_table(), testing::HasSubstr("100.000 .. 100.000"));
  simulation.world().destroy(again);
  stats.record(simulation);
  EXPECT_FALSE(stats.any());
}

}  // namespace
}  // namespace fascicle::game
