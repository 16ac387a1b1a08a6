// The same simulation on 1, 2, 3 and 8 workers, down to the bits and the order of entities; and random schedules whose
// systems watch that nobody they conflict with runs beside them.
#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <bit>
#include <cmath>
#include <cstdint>
#include <random>
#include <utility>
#include <vector>

#include "engine/ecs/each_in_parallel.hpp"
#include "engine/ecs/schedule.hpp"
#include "engine/parallel/ordered_sum.hpp"

namespace fascicle::ecs {
namespace {

struct Position {
  float x = 0, y = 0;
};
struct Velocity {
  float x = 0, y = 0;
};
struct Age {
  int frames = 0;
};
struct Energy {
  float total = 0;
  std::vector<float> partial;
};

constexpr std::size_t kGrain = 64;

void turn(View<Velocity> view) {
  each_in_parallel(view, kGrain, [](Velocity& v) { v = {0.96F * v.x - 0.28F * v.y, 0.28F * v.x + 0.96F * v.y}; });
}
void grow_old(View<Age> view) {
  view.each([](Age& age) { ++age.frames; });
}
void fly(View<Position, const Velocity> view) {
  each_in_parallel(view, kGrain, [](Position& p, const Velocity& v) {
    p.x += 0.01F * v.x;
    p.y += 0.01F * v.y;
  });
}
void sum_energy(View<const Velocity> view, Resource<Energy> energy) {
  energy->partial.resize(parallel::chunk_count(view.candidates(), kGrain));
  energy->total = parallel::ordered_sum(
      view.candidates(), kGrain, std::span<float>(energy->partial), [&](std::size_t begin, std::size_t end) {
        float sum = 0;
        const auto add = [&](const Velocity& v) { sum += v.x * v.x + v.y * v.y; };
        for (std::size_t i = begin; i < end; ++i) view.visit(i, add);
        return sum;
      });
}
void damp(View<Velocity> view, Resource<const Energy> energy) {
  const float factor = 1.0F / (1.0F + 1e-4F * energy->total);
  view.each([&](Velocity& v) { v = {v.x * factor, v.y * factor}; });
}
void die(View<const Age> view, Commands& commands) {
  view.each([&](Entity entity, const Age& age) {
    if (age.frames % 17 == static_cast<int>(entity.index % 17)) commands.destroy(entity);
  });
}
void be_born(View<const Position, const Age> view, Commands& commands) {
  view.each([&](const Position& position, const Age& age) {
    if (age.frames % 11 != 0) return;
    const Entity child = commands.create();
    commands.add<Age>(child, {static_cast<int>(std::fabs(position.x) * 10)});
    commands.add<Position>(child, {position.y, position.x});
    commands.add<Velocity>(child, {position.x, 1});
  });
}

class Hash {
 public:
  void add(std::uint32_t value) { hash_ = (hash_ ^ value) * 0x100000001b3u; }
  void add(float value) { add(std::bit_cast<std::uint32_t>(value)); }
  std::uint64_t value() const { return hash_; }

 private:
  std::uint64_t hash_ = 0xcbf29ce484222325u;
};

std::vector<std::uint64_t> simulate(int workers) {
  World world;
  world.set_resource(Energy{});
  for (int i = 0; i < 2000; ++i) {
    const Entity entity = world.create();
    const float f = static_cast<float>(i);
    world.add<Position>(entity, {std::sin(f), std::cos(f)});
    if (i % 2 == 0) world.add<Velocity>(entity, {std::cos(3 * f), std::sin(5 * f)});
    if (i % 3 == 0) world.add<Age>(entity, {i % 29});
  }
  Schedule schedule;
  schedule.add("turn", turn);
  schedule.add("grow_old", grow_old);
  schedule.add("sum_energy", sum_energy);
  schedule.add("fly", fly);
  schedule.add("die", die);
  schedule.add("damp", damp);
  schedule.add_barrier();
  schedule.add("be_born", be_born);
  parallel::WorkerArena arena(workers);
  std::vector<std::uint64_t> hashes;
  for (int frame = 0; frame < 40; ++frame) {
    schedule.run(world, arena);
    Hash hash;
    hash.add(world.resource<Energy>().total);
    world.view<const Position>().each([&](Entity entity, const Position& p) {
      hash.add(entity.index);
      hash.add(entity.generation);
      hash.add(p.x);
      hash.add(p.y);
    });
    world.view<const Velocity>().each([&](Entity entity, const Velocity& v) {
      hash.add(entity.index);
      hash.add(v.x);
      hash.add(v.y);
    });
    hashes.push_back(hash.value());
  }
  return hashes;
}

TEST(ScheduleDeterminism, ResultsDoNotDependOnTheNumberOfWorkers) {
  const std::vector<std::uint64_t> expected = simulate(1);
  for (std::size_t i = 1; i < expected.size(); ++i) EXPECT_NE(expected[i], expected[i - 1]) << "nothing moves";
  for (const int workers : {1, 2, 3, 8}) EXPECT_EQ(simulate(workers), expected) << workers << " workers";
}

// Random schedules over four slots. A system announces itself in its slots' gates while it runs.
template <std::size_t N>
struct Slot {
  std::uint64_t value = N;
};

struct Gate {
  std::atomic<int> readers = 0;
  std::atomic<int> writers = 0;
};
struct Gates {
  std::array<Gate, 4> gate;
  std::atomic<int> violations = 0;
};

template <std::size_t R, std::size_t W>
void add_system(Schedule& schedule, Gates& gates, std::uint64_t id) {
  schedule.add("system", [&gates, id](View<const Slot<R>> read, View<Slot<W>> write) {
    Gate& r = gates.gate[R];
    Gate& w = gates.gate[W];
    if (R != W) r.readers.fetch_add(1);
    if (w.writers.fetch_add(1) != 0 || w.readers.load() != 0) gates.violations.fetch_add(1);
    if (R != W && r.writers.load() != 0) gates.violations.fetch_add(1);
    std::uint64_t sum = id;
    read.each([&](const Slot<R>& slot) { sum = sum * 31 + slot.value; });
    write.each([&](Slot<W>& slot) { slot.value = slot.value * 1099511628211u + sum; });
    w.writers.fetch_sub(1);
    if (R != W) r.readers.fetch_sub(1);
  });
}

using Adder = void (*)(Schedule&, Gates&, std::uint64_t);
template <std::size_t... I>
constexpr std::array<Adder, 16> all_adders(std::index_sequence<I...>) {
  return {add_system<I / 4, I % 4>...};
}

std::vector<std::uint64_t> run_random(std::uint32_t seed, int workers, int& violations) {
  constexpr std::array<Adder, 16> kAdders = all_adders(std::make_index_sequence<16>{});
  std::mt19937 random(seed);
  Gates gates;
  Schedule schedule;
  const std::uint32_t count = 2 + random() % 30;
  for (std::uint32_t id = 0; id < count; ++id) {
    kAdders[random() % 16](schedule, gates, id);
    if (random() % 8 == 0) schedule.add_barrier();
  }
  World world;
  for (int i = 0; i < 300; ++i) {
    const Entity entity = world.create();
    world.add<Slot<0>>(entity);
    world.add<Slot<1>>(entity);
    world.add<Slot<2>>(entity);
    world.add<Slot<3>>(entity);
  }
  parallel::WorkerArena arena(workers);
  for (int frame = 0; frame < 3; ++frame) schedule.run(world, arena);
  std::vector<std::uint64_t> result;
  world.view<const Slot<0>, const Slot<1>, const Slot<2>, const Slot<3>>().each(
      [&](const Slot<0>& a, const Slot<1>& b, const Slot<2>& c, const Slot<3>& d) {
        result.insert(result.end(), {a.value, b.value, c.value, d.value});
      });
  violations = gates.violations;
  return result;
}

TEST(ScheduleDeterminism, RandomSchedulesGiveTheSerialResult) {
  for (std::uint32_t seed = 0; seed < 60; ++seed) {
    int violations = 0;
    const std::vector<std::uint64_t> expected = run_random(seed, 1, violations);
    EXPECT_EQ(violations, 0);
    for (const int workers : {2, 3, 8}) {
      EXPECT_EQ(run_random(seed, workers, violations), expected) << "seed " << seed << ", " << workers << " workers";
      EXPECT_EQ(violations, 0) << "seed " << seed << ", " << workers << " workers";
    }
  }
}

}  // namespace
}  // namespace fascicle::ecs
