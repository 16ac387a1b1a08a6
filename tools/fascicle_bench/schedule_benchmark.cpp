// What a schedule costs beside its systems: frames of 20 systems that do nothing, timed each as always. `chain`: every
// system waits for the one before; `independent`: none waits; `frame`: a muscle frame's shape, 5 chains of 4.
// The argument is the number of workers. `_reference`: the same systems called one after another by hand.
#include <benchmark/benchmark.h>

#include <array>
#include <cstddef>
#include <string>
#include <utility>

#include "engine/ecs/schedule.hpp"
#include "engine/ecs/view.hpp"
#include "engine/parallel/for_range.hpp"

namespace {

using namespace fascicle::ecs;

constexpr std::size_t kSystems = 20;
constexpr std::size_t kEntities = 64;

template <std::size_t I>
struct Slot {
  float value = 0;
};

template <std::size_t I>
void write_slot(View<Slot<I>> view) {
  benchmark::DoNotOptimize(view);
}

template <std::size_t... I>
void add_entities(World& world, std::index_sequence<I...>) {
  for (std::size_t n = 0; n < kEntities; ++n) {
    const Entity entity = world.create();
    (world.add<Slot<I>>(entity), ...);
  }
}

template <std::size_t... I>
void add_independent(Schedule& schedule, std::index_sequence<I...>) {
  (schedule.add("system " + std::to_string(I), write_slot<I>), ...);
}

void add_chain(Schedule& schedule) {
  for (std::size_t i = 0; i < kSystems; ++i) schedule.add("system " + std::to_string(i), write_slot<0>);
}

// System i of a chain of 4 writes the slot of its chain.
template <std::size_t... I>
void add_frame(Schedule& schedule, std::index_sequence<I...>) {
  (schedule.add("system " + std::to_string(I), write_slot<I / 4>), ...);
}

enum class Shape { kChain, kIndependent, kFrame };

void schedule_overhead(benchmark::State& state, Shape shape) {
  constexpr auto kAll = std::make_index_sequence<kSystems>{};
  World world;
  add_entities(world, kAll);
  Schedule schedule;
  if (shape == Shape::kChain) add_chain(schedule);
  if (shape == Shape::kIndependent) add_independent(schedule, kAll);
  if (shape == Shape::kFrame) add_frame(schedule, kAll);
  fascicle::parallel::WorkerArena arena(static_cast<int>(state.range(0)));
  for (auto _ : state) schedule.run(world, arena);
  state.counters["systems"] = kSystems;
}
BENCHMARK_CAPTURE(schedule_overhead, chain, Shape::kChain)->Arg(1)->Arg(2)->Arg(8)->UseRealTime();
BENCHMARK_CAPTURE(schedule_overhead, independent, Shape::kIndependent)->Arg(1)->Arg(2)->Arg(8)->UseRealTime();
BENCHMARK_CAPTURE(schedule_overhead, frame, Shape::kFrame)->Arg(1)->Arg(2)->Arg(8)->UseRealTime();

template <std::size_t... I>
void call_all(World& world, std::index_sequence<I...>) {
  (write_slot<I>(world.view<Slot<I>>()), ...);
}

void schedule_overhead_reference(benchmark::State& state) {
  constexpr auto kAll = std::make_index_sequence<kSystems>{};
  World world;
  add_entities(world, kAll);
  for (auto _ : state) call_all(world, kAll);
}
BENCHMARK(schedule_overhead_reference)->UseRealTime();

// The same on a loop instead of a graph: starting a parallel loop of 64 chunks that do nothing.
void for_range_overhead(benchmark::State& state) {
  fascicle::parallel::WorkerArena arena(static_cast<int>(state.range(0)));
  std::array<int, 64> touched{};
  arena.execute([&] {
    for (auto _ : state) {
      fascicle::parallel::for_range(touched.size(), 1, [&](std::size_t begin, std::size_t) { touched[begin] = 1; });
      benchmark::DoNotOptimize(touched);
    }
  });
}
BENCHMARK(for_range_overhead)->Arg(1)->Arg(2)->Arg(8)->UseRealTime();

}  // namespace
