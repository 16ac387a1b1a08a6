#include "game/simulation.hpp"

#include <cmath>
#include <set>

#include <gmock/gmock.h>

#include "engine/animation/skeleton.hpp"
#include "engine/animation/skinning.hpp"
#include "modules/muscle/muscle.hpp"
#include "tests/support/allocation_counter.hpp"
#include "tests/support/test_data.hpp"

namespace fascicle::game {
namespace {

std::filesystem::path scene_file(const char* name) {
  return std::filesystem::path(FASCICLE_SOURCE_DIR) / "content" / "scenes" / (std::string(name) + ".scene.json");
}

std::shared_ptr<const muscle::SceneAsset> load(const char* name) {
  auto scene = muscle::load_scene(scene_file(name), {.data_folder = test::data_folder()});
  EXPECT_TRUE(scene.ok()) << to_text(scene.diagnostics());
  return scene.ok() ? *scene : nullptr;
}

std::uint64_t hash_after(const std::shared_ptr<const muscle::SceneAsset>& scene, int steps, SimulationOptions options) {
  Simulation simulation(scene, options);
  for (int i = 0; i < steps; ++i) simulation.step();
  return simulation.hash();
}

// Every number that leaves the simulation is finite, and no muscle was held back.
void expect_healthy(const Simulation& simulation) {
  for (const SpawnedCharacter& character : simulation.characters()) {
    if (character.musculature == ecs::kNoEntity) continue;
    const auto& surfaces = simulation.world().get<muscle::MuscleSurfaces>(character.musculature);
    for (const muscle::SurfaceVertex& vertex : surfaces.vertices) {
      ASSERT_TRUE(std::isfinite(vertex.position.x + vertex.position.y + vertex.position.z));
    }
    EXPECT_EQ(simulation.world().get<muscle::ActionLines>(character.musculature).held_steps, 0u);
  }
}

TEST(Simulation, WalkerHashIsTheSameForAnyNumberOfThreads) {
  const auto scene = load("walker");
  ASSERT_TRUE(scene);
  const std::uint64_t one = hash_after(scene, 40, {.workers = 1, .copies = 5});
  for (const int workers : {2, 3, 8}) {
    EXPECT_EQ(hash_after(scene, 40, {.workers = workers, .copies = 5}), one) << workers << " workers";
  }
}

TEST(Simulation, WalkerHashIsTheSameOnAllInstructionSets) {
  const auto scene = load("walker");
  ASSERT_TRUE(scene);
  const std::uint64_t portable = hash_after(scene, 40, {.workers = 1, .simd = SimdLevel::kPortable});
  for (const SimdLevel level : {SimdLevel::kAvx2, SimdLevel::kAvx512}) {
    if (level > detect_simd()) continue;
    EXPECT_EQ(hash_after(scene, 40, {.workers = 1, .simd = level}), portable) << to_string(level);
  }
}

TEST(Simulation, WalkerMovesEveryFrame) {
  const auto scene = load("walker");
  ASSERT_TRUE(scene);
  Simulation simulation(scene, {.workers = 1});
  std::set<std::uint64_t> hashes;
  for (int i = 0; i < 100; ++i) {
    simulation.step();
    hashes.insert(simulation.hash());
  }
  EXPECT_EQ(hashes.size(), 100u);
  expect_healthy(simulation);
}

TEST(Simulation, SteadyFramesAllocateNothing) {
  const auto scene = load("walker");
  ASSERT_TRUE(scene);
  for (const int workers : {1, 2}) {
    Simulation simulation(scene, {.workers = workers, .copies = 3});
    for (int i = 0; i < 5; ++i) simulation.step();
    const test::AllocationScope count;
    for (int i = 0; i < 20; ++i) simulation.step();
    EXPECT_EQ(count.allocations(), 0u) << workers << " workers";
  }
}

// A viewer who walks backwards: levels follow, on any number of threads, and nothing is allocated.
TEST(Simulation, MusclesGetCoarserAsTheViewerRecedes) {
  const auto scene = load("walker");
  ASSERT_TRUE(scene);
  const auto run = [&](int workers) {
    Simulation simulation(scene, {.workers = workers, .copies = 5});
    const std::uint64_t finest = simulation.count_details().vertices;
    double before = 0.0;
    for (int i = 0; i < 60; ++i) {
      simulation.set_viewer({.enabled = true, .eye = {0.0f, 1.0f, 1.0f * static_cast<float>(i)},
                             .pixels_per_radian = 1000.0f});
      const test::AllocationScope count;
      simulation.step();
      if (i > 4) {
        EXPECT_EQ(count.allocations(), 0u) << "step " << i;
      }
      const double now = simulation.count_details().mean_level;
      EXPECT_GE(now, before - 0.05);  // a step of the walk towards the viewer
      before = now;
    }
    const Simulation::DetailCounts counts = simulation.count_details();
    EXPECT_EQ(counts.mean_level, static_cast<double>(counts.characters.size() - 1));
    EXPECT_EQ(counts.characters.back(), 5u);
    EXPECT_GE(counts.switches, 5u);
    EXPECT_LT(counts.vertices, finest / 2);
    expect_healthy(simulation);
    return simulation.hash();
  };
  const std::uint64_t one = run(1);
  EXPECT_EQ(run(2), one);
  EXPECT_EQ(run(3), one);
}

TEST(Simulation, SwappingInTheSameSceneChangesNothing) {
  const auto scene = load("walker");
  ASSERT_TRUE(scene);
  // Without collision: what is pressed depends on the steps before, and starts afresh.
  const SimulationOptions options{.workers = 1, .collision = false};
  Simulation simulation(scene, options);
  for (int i = 0; i < 30; ++i) simulation.step();
  simulation.swap_scene(load("walker"));
  for (int i = 0; i < 30; ++i) simulation.step();
  EXPECT_EQ(simulation.hash(), hash_after(scene, 60, options));
}

TEST(Simulation, MemoryCountsWhatComponentsOwn) {
  const auto scene = load("walker");
  ASSERT_TRUE(scene);
  const Simulation simulation(scene, {.workers = 1});
  const SpawnedCharacter& walker = simulation.characters()[0];
  const std::size_t bones = walker.asset->skeleton->size(), skin = walker.asset->skins[0]->size();
  std::size_t found = 0;
  for (const ecs::ComponentMemory& row : simulation.world().memory_by_component()) {
    if (row.name == "BoneMatrices") {
      ++found;
      EXPECT_GE(row.bytes, bones * sizeof(glm::mat4));
    }
    if (row.name == "LocalPose") {
      ++found;
      EXPECT_GE(row.bytes, bones * sizeof(Trs));
    }
    if (row.name == "SkinnedSurface") {
      ++found;
      EXPECT_GE(row.bytes, 2 * skin * sizeof(glm::vec3));
    }
    if (row.name == "MuscleSurfaces") {
      ++found;
      EXPECT_GE(row.bytes, 5280 * sizeof(muscle::SurfaceVertex));
    }
  }
  EXPECT_EQ(found, 4u);
}

TEST(Simulation, ARefreshIsNoStep) {
  const auto scene = load("walker");
  ASSERT_TRUE(scene);
  Simulation simulation(scene, {.workers = 1});
  for (int i = 0; i < 20; ++i) simulation.step();
  const std::uint64_t before = simulation.hash();
  simulation.refresh();
  EXPECT_EQ(simulation.hash(), before);
  EXPECT_EQ(simulation.steps(), 20u);
}

TEST(Simulation, AReloadedStepLengthAndSpeedTakeEffect) {
  const auto scene = load("walker");
  ASSERT_TRUE(scene);
  Simulation simulation(scene, {.workers = 1});
  for (int i = 0; i < 30; ++i) simulation.step();
  auto edited = std::make_shared<muscle::SceneAsset>(*scene);
  edited->step_hz = 30.0f;
  edited->characters[0].animation.speed = 0.5f;
  simulation.swap_scene(edited);
  EXPECT_FLOAT_EQ(simulation.loop().time().step, 1.0f / 30.0f);
  const double before = simulation.loop().time().time;
  simulation.step();
  EXPECT_NEAR(simulation.loop().time().time - before, 1.0 / 30.0, 1e-7);

  // A fresh start at the edited speed reaches the same pose.
  Simulation fresh(edited, {.workers = 1});
  while (fresh.loop().time().time < simulation.loop().time().time - 1e-6) fresh.step();
  const auto& here = simulation.world().get<BoneMatrices>(simulation.characters()[0].entity).world;
  const auto& there = fresh.world().get<BoneMatrices>(fresh.characters()[0].entity).world;
  for (std::size_t bone = 0; bone < here.size(); ++bone) {
    EXPECT_LT(glm::length(glm::vec3(here[bone][3] - there[bone][3])), 1e-4f);
  }
}

TEST(Simulation, CopiesAreNotInLockstepAndStandApart) {
  const auto scene = load("walker");
  ASSERT_TRUE(scene);
  Simulation simulation(scene, {.workers = 1, .copies = 4});
  for (int i = 0; i < 10; ++i) simulation.step();
  std::set<float> lengths;
  for (const SpawnedCharacter& character : simulation.characters()) {
    lengths.insert(simulation.world().get<muscle::MuscleMeasures>(character.musculature).length[0]);
  }
  EXPECT_EQ(lengths.size(), 4u);
}

TEST(Simulation, Gait2392WalksForTwoCycles) {
  FASCICLE_SKIP_WITHOUT_DATA("opensim/walk.mot");
  const auto scene = load("gait2392");
  ASSERT_TRUE(scene);
  Simulation simulation(scene, {.workers = 2});
  ASSERT_EQ(simulation.characters().size(), 1u);
  EXPECT_EQ(simulation.characters()[0].asset->muscles->size(), 92u);
  for (int i = 0; i < 160; ++i) {
    simulation.step();
    expect_healthy(simulation);
  }
  EXPECT_EQ(hash_after(scene, 160, {.workers = 3}), simulation.hash());
}

TEST(Simulation, CesiumManWalksWithADozenMuscles) {
  FASCICLE_SKIP_WITHOUT_DATA("gltf/CesiumMan.glb");
  const auto scene = load("cesium-man");
  ASSERT_TRUE(scene);
  Simulation simulation(scene, {.workers = 2});
  EXPECT_EQ(simulation.characters()[0].asset->muscles->size(), 12u);
  for (int i = 0; i < 150; ++i) {
    simulation.step();
    expect_healthy(simulation);
  }
}

}  // namespace
}  // namespace fascicle::game
