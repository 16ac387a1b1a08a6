// Surface muscles in a running scene: spawned with their character, swapped with it, in its hash, the same for any
// number of threads.
#include <algorithm>
#include <filesystem>
#include <memory>
#include <span>

#include <gmock/gmock.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "engine/animation/skeleton.hpp"
#include "game/simulation.hpp"
#include "modules/muscle/components/surface_muscle.hpp"
#include "modules/muscle/muscle.hpp"
#include "tests/support/allocation_counter.hpp"
#include "tests/support/test_data.hpp"

namespace fascicle::game {
namespace {

std::shared_ptr<const muscle::SceneAsset> load(const char* name) {
  const auto file = std::filesystem::path(FASCICLE_SOURCE_DIR) / "content" / "scenes" / (std::string(name) + ".scene.json");
  const auto scene = muscle::load_scene(file, {.data_folder = test::data_folder()});
  EXPECT_TRUE(scene.ok()) << to_text(scene.diagnostics());
  return scene.ok() ? *scene : nullptr;
}

const std::shared_ptr<const muscle::SceneAsset>& walker() {
  static const auto scene = load("walker-surface");
  return scene;
}

std::size_t count_surfaces(const ecs::World& world) {
  std::size_t count = 0;
  world.view<const muscle::SurfaceMuscle>().each([&](const muscle::SurfaceMuscle&) { ++count; });
  return count;
}

std::uint64_t hash_after(const muscle::SceneAsset& scene, int steps, SimulationOptions options) {
  Simulation simulation(std::make_shared<const muscle::SceneAsset>(scene), options);
  for (int i = 0; i < steps; ++i) simulation.step();
  return simulation.hash();
}

// Of the box round them, m.
glm::vec3 middle_of(std::span<const muscle::SurfaceVertex> vertices) {
  glm::vec3 lower(vertices.front().position), upper(lower);
  for (const muscle::SurfaceVertex& vertex : vertices) {
    lower = glm::min(lower, vertex.position);
    upper = glm::max(upper, vertex.position);
  }
  return 0.5f * (lower + upper);
}

TEST(SurfaceSimulation, TheWalkersMeshesAreDrivenByItsMuscles) {
  ASSERT_TRUE(walker());
  Simulation simulation(walker(), {.workers = 1});
  ASSERT_EQ(simulation.characters().size(), 1u);
  const SpawnedCharacter& character = simulation.characters()[0];
  ASSERT_EQ(character.surfaces.size(), 12u);
  const auto& descriptions = character.asset->descriptions;
  std::size_t hidden = 0;
  for (const std::uint8_t one : character.asset->hidden_muscles) hidden += one;
  EXPECT_EQ(hidden, 12u);
  for (int i = 0; i < 20; ++i) simulation.step();
  for (const ecs::Entity entity : character.surfaces) {
    const auto& muscle = simulation.world().get<muscle::SurfaceMuscle>(entity);
    EXPECT_EQ(muscle.character, character.entity);
    ASSERT_EQ(muscle.musculature, character.musculature);
    EXPECT_EQ(descriptions[muscle.driver].name, muscle.asset->name);
    EXPECT_EQ(character.asset->hidden_muscles[muscle.driver], 1);
    const auto& state = simulation.world().get<muscle::SurfaceState>(entity);
    EXPECT_NEAR(state.volume / muscle.asset->volume, 1.0, 0.02) << muscle.asset->name;
    EXPECT_EQ(state.fallbacks, 0u) << muscle.asset->name;
    // Where its driver is: the boxes round the two have nearly the same middle.
    const muscle::MuscleSurfaceView driver =
        muscle::surface_of(simulation.world(), muscle::muscle_entity(simulation.world(), character.musculature,
                                                                     muscle.asset->driver));
    ASSERT_FALSE(driver.vertices.empty());
    const glm::vec3 middle = middle_of(simulation.world().get<muscle::DrawnSurface>(entity).vertices);
    EXPECT_LT(glm::distance(middle, middle_of(driver.vertices)), 0.03f) << muscle.asset->name;
  }
}

TEST(SurfaceSimulation, TheHashIsTheSameForAnyNumberOfThreadsAndTellsSurfacesApart) {
  ASSERT_TRUE(walker());
  const std::uint64_t one = hash_after(*walker(), 5, {.workers = 1, .copies = 2});
  EXPECT_EQ(hash_after(*walker(), 5, {.workers = 3, .copies = 2}), one);
  Simulation simulation(walker(), {.workers = 1});
  simulation.step();
  const std::uint64_t before = simulation.hash();
  simulation.world().get<muscle::SurfaceState>(simulation.characters()[0].surfaces[3]).points[7].x += 1e-6f;
  EXPECT_NE(simulation.hash(), before);
}

TEST(SurfaceSimulation, SteadyFramesAllocateNothing) {
  ASSERT_TRUE(walker());
  Simulation simulation(walker(), {.workers = 1});
  for (int i = 0; i < 3; ++i) simulation.step();
  const test::AllocationScope count;
  for (int i = 0; i < 3; ++i) simulation.step();
  EXPECT_EQ(count.allocations(), 0u);
}

// A newer version of the scene, as live reload brings it: other muscles, other settings, none left behind.
TEST(SurfaceSimulation, AreExchangedWithTheScene) {
  ASSERT_TRUE(walker());
  Simulation simulation(walker(), {.workers = 1});
  simulation.step();
  auto character = std::make_shared<muscle::CharacterAsset>(*walker()->characters[0].character);
  character->surface_muscles.resize(2);
  auto changed = std::make_shared<muscle::SurfaceAsset>(*character->surface_muscles[0]);
  changed->settings.substeps = 2;
  character->surface_muscles[0] = changed;
  auto scene = std::make_shared<muscle::SceneAsset>(*walker());
  scene->characters[0].character = character;
  simulation.swap_scene(scene);
  ASSERT_EQ(simulation.characters()[0].surfaces.size(), 2u);
  EXPECT_EQ(count_surfaces(simulation.world()), 2u);
  const auto& first = simulation.world().get<muscle::SurfaceMuscle>(simulation.characters()[0].surfaces[0]);
  EXPECT_EQ(first.settings.substeps, 2u);
  simulation.step();
  EXPECT_EQ(simulation.world().get<muscle::SurfaceState>(simulation.characters()[0].surfaces[0]).fallbacks, 0u);
}

TEST(SurfaceSimulation, TouchNothingWhereCollisionIsOff) {
  ASSERT_TRUE(walker());
  Simulation simulation(walker(), {.workers = 1, .collision = false});
  simulation.step();
  for (const ecs::Entity entity : simulation.characters()[0].surfaces) {
    EXPECT_TRUE(simulation.world().get<muscle::SurfaceContacts>(entity).now.empty());
  }
}

// Characters without musculotendon units are simulated, too.
TEST(SurfaceSimulation, TheBoxStandsBetweenItsPlates) {
  FASCICLE_SKIP_WITHOUT_DATA("pbd/box.vtk");
  const auto scene = load("box");
  ASSERT_TRUE(scene);
  Simulation simulation(scene, {.workers = 1});
  ASSERT_EQ(simulation.characters()[0].surfaces.size(), 1u);
  EXPECT_EQ(simulation.characters()[0].musculature, ecs::kNoEntity);
  for (int i = 0; i < 30; ++i) simulation.step();
  // 27 mm of the gap's 100 are gone, and the box was 80 high: it is pressed.
  const ecs::Entity box = simulation.characters()[0].surfaces[0];
  const auto& state = simulation.world().get<muscle::SurfaceState>(box);
  float lowest = 1.0f, highest = -1.0f;
  for (const muscle::SurfaceVertex& vertex : simulation.world().get<muscle::DrawnSurface>(box).vertices) {
    lowest = std::min(lowest, vertex.position.y);
    highest = std::max(highest, vertex.position.y);
  }
  EXPECT_GT(lowest, 0.5f - 0.001f);  // the bottom plate's top, where the scene has it
  EXPECT_LT(highest, 0.573f + 0.001f);
  EXPECT_EQ(state.fallbacks, 0u);
  EXPECT_EQ(simulation.held_steps(), 0u);
}

}  // namespace
}  // namespace fascicle::game
