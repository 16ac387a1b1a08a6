// What must hold of every frame: no allocation, the same state for any number of workers and any instruction set, with
// or without streaming stores and timing of single muscles.
#include <limits>
#include <string>

#include "engine/ecs/world.hpp"
#include "engine/loop/cost_ledger.hpp"
#include "tests/modules/muscle/systems/muscle_world.hpp"
#include "tests/support/allocation_counter.hpp"

namespace fascicle::muscle {
namespace {

// Hashes of 12 frames of 9 walkers out of step.
std::vector<std::uint64_t> run_walkers(int workers, const MuscleSettings& settings, bool costs) {
  MuscleWorld w(workers, settings);
  const auto asset = synthetic_asset(10, 1);
  std::vector<ecs::Entity> characters;
  for (int i = 0; i < 9; ++i) {
    characters.push_back(w.add_character(test::rest_bones()));
    const ecs::Entity muscles = spawn_musculature(w.world, characters.back(), asset);
    list_costs(w.world, muscles, "walker " + std::to_string(i));
  }
  if (costs) w.world.resource<CostLedger>().set_enabled(true);
  std::vector<std::uint64_t> hashes;
  for (int frame = 0; frame < 12; ++frame) {
    for (std::size_t i = 0; i < characters.size(); ++i) {
      w.pose(characters[i], test::walk_bones(0.05f * static_cast<float>(frame) + 0.1f * static_cast<float>(i)));
    }
    w.step();
    w.world.resource<CostLedger>().end_frame();
    hashes.push_back(hash_state(w.world));
  }
  if (costs) {
    std::size_t per_muscle = 0;
    for (const ItemCost& cost : w.world.resource<CostLedger>().statistics()) per_muscle += cost.item.empty() ? 0 : 1;
    EXPECT_GE(per_muscle, 2u * 9 * 48);  // measure_muscles and write_surfaces tell muscles apart
  }
  return hashes;
}

TEST(SteadyFrame, StateIsTheSameForAnyWorkersAndInstructionSet) {
  MuscleSettings settings;
  settings.simd = SimdLevel::kPortable;
  const std::vector<std::uint64_t> expected = run_walkers(1, settings, false);
  for (std::size_t i = 1; i < expected.size(); ++i) EXPECT_NE(expected[i], expected[i - 1]);
  for (const int workers : {1, 2, 3, 8}) {
    for (const SimdLevel level : {SimdLevel::kPortable, SimdLevel::kAvx2, SimdLevel::kAvx512}) {
      if (level > detect_simd()) continue;
      settings.simd = level;
      settings.stream_bytes = workers % 2 == 0 ? 0 : std::size_t{1} << 40;
      EXPECT_EQ(run_walkers(workers, settings, workers == 3), expected) << workers << " " << to_string(level);
    }
  }
}

TEST(SteadyFrame, NothingIsAllocated) {
  for (const int workers : {1, 2}) {
    MuscleWorld w(workers);
    const auto asset = synthetic_asset();
    std::vector<ecs::Entity> characters;
    for (int i = 0; i < 10; ++i) {
      characters.push_back(w.add_character(test::rest_bones()));
      spawn_musculature(w.world, characters.back(), asset);
    }
    for (int frame = 0; frame < 20; ++frame) {
      std::vector<std::vector<glm::mat4>> poses;
      for (std::size_t i = 0; i < characters.size(); ++i) {
        poses.push_back(test::walk_bones(0.02f * static_cast<float>(frame) + 0.1f * static_cast<float>(i)));
        if (frame == 15) poses.back()[2][3].x = std::numeric_limits<float>::quiet_NaN();  // holding allocates no more
      }
      for (std::size_t i = 0; i < characters.size(); ++i) w.pose(characters[i], poses[i]);
      const test::AllocationScope scope;
      w.step();
      if (frame >= 10) {
        EXPECT_EQ(scope.allocations(), 0u) << "frame " << frame << ", " << workers << " workers";
      }
    }
  }
}

}  // namespace
}  // namespace fascicle::muscle
