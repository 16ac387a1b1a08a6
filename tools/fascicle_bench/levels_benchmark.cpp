// What levels of detail save: a step of the muscle systems for 1,000 walkers of 48 muscles on a square of 32 by 32,
// 1.4 m apart, seen from its edge in a picture of 720 pixels, on one thread. All walk to and fro by half a metre, so
// that many morph and some change level in every step.
//
//   levels/1000_walkers            each at the level that its size in the picture asks for
//   levels/1000_walkers_reference  all at their finest
//
// The levels have |C| = 24, 12, 6 and LSS 2, 1, 1. Counters: vertices of all, mean level and how many morph, in the
// last step; exchanges of a level a step.
#include <benchmark/benchmark.h>

#include <cmath>
#include <vector>

#include <glm/gtc/matrix_transform.hpp>

#include "engine/animation/skeleton.hpp"
#include "engine/ecs/schedule.hpp"
#include "engine/ecs/world.hpp"
#include "modules/muscle/muscle.hpp"
#include "tests/support/synthetic_levels.hpp"

namespace {

using namespace fascicle;
using namespace fascicle::muscle;

constexpr int kWalkers = 1000, kColumns = 32;
constexpr float kSpacing = 1.4f;             // m
constexpr float kPixelsPerRadian = 986.0f;   // 720 pixels for a field of view of 0.7 rad
constexpr std::size_t kPoses = 64;           // of a cycle of one second

void levels_frame(benchmark::State& state, bool by_size) {
  const auto levels = test::synthetic_levels({24, 2}, 3, 0.1f);
  ecs::World world;
  prepare_muscles(world);
  Viewer viewer{.enabled = true, .eye = {0.7f * kColumns, 1.5f, 3.0f}, .pixels_per_radian = kPixelsPerRadian};
  if (!by_size) viewer.level = 0;
  world.set_resource(viewer);
  ecs::Schedule schedule;
  add_muscle_systems(schedule);
  parallel::WorkerArena arena(1);

  std::vector<std::vector<glm::mat4>> poses;
  for (std::size_t i = 0; i < kPoses; ++i) {
    const float way = static_cast<float>(i) / kPoses;
    const float z = 0.5f * std::sin(6.2831853f * way) - 1.2f * way;  // the pose has 1.2 m/s of its own
    poses.push_back(test::walk_bones(way, {0.0f, 0.95f, z}));
  }
  std::vector<ecs::Entity> characters, musculatures;
  for (int i = 0; i < kWalkers; ++i) {
    characters.push_back(world.create());
    world.add(characters.back(), BoneMatrices{test::rest_bones(), 0});
    musculatures.push_back(spawn_musculature(world, characters.back(), levels));
  }
  std::size_t frame = 0;
  const auto step = [&] {
    for (std::size_t i = 0; i < characters.size(); ++i) {
      const glm::vec4 place(kSpacing * static_cast<float>(i % kColumns), 0.0f,
                            -kSpacing * static_cast<float>(i / kColumns), 0.0f);
      std::vector<glm::mat4>& bones = world.get<BoneMatrices>(characters[i]).world;
      const std::vector<glm::mat4>& pose = poses[(frame + 7 * i) % kPoses];
      for (std::size_t b = 0; b < bones.size(); ++b) {
        bones[b] = pose[b];
        bones[b][3] += place;
      }
    }
    schedule.run(world, arena);
    ++frame;
  };
  const auto count_switches = [&] {
    std::uint64_t sum = 0;
    for (const ecs::Entity entity : musculatures) sum += world.get<MuscleDetail>(entity).switches;
    return sum;
  };
  for (int i = 0; i < 3; ++i) step();  // everyone is where he belongs
  const std::uint64_t before = count_switches();
  for (auto _ : state) step();

  double vertices = 0.0, level = 0.0, morphing = 0.0;
  for (const ecs::Entity entity : musculatures) {
    const Musculature& musculature = world.get<Musculature>(entity);
    vertices += static_cast<double>(musculature.asset->vertex_count);
    level += static_cast<double>(world.get<MuscleDetail>(entity).level) + static_cast<double>(musculature.morph);
    morphing += musculature.morph > 0.0f ? 1.0 : 0.0;
  }
  state.counters["vertices"] = vertices;
  state.counters["level"] = level / kWalkers;
  state.counters["morphing"] = morphing;
  state.counters["switches"] =
      static_cast<double>(count_switches() - before) / static_cast<double>(state.iterations());
}

BENCHMARK_CAPTURE(levels_frame, by_size, true)->Name("levels/1000_walkers")->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(levels_frame, finest, false)->Name("levels/1000_walkers_reference")->Unit(benchmark::kMillisecond);

}  // namespace
