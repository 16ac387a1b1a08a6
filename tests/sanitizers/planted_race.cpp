// Two systems with a race between them, for tests/sanitizers/prove_race_is_found to find: they share a counter through
// a pointer that their signatures do not declare, so the schedule runs them side by side. Not part of the tests.
// With the argument `none` the same schedule runs without the race and must be found clean.
#include <atomic>
#include <cstdio>
#include <string_view>

#include "engine/ecs/each_in_parallel.hpp"
#include "engine/ecs/schedule.hpp"

namespace {

using namespace fascicle;
using namespace fascicle::ecs;

struct A {
  int value = 0;
};
struct B {
  int value = 0;
};

}  // namespace

int main(int argc, char** argv) {
  const bool race = argc < 2 || std::string_view(argv[1]) != "none";
  World world;
  for (int i = 0; i < 1000; ++i) {
    const Entity entity = world.create();
    world.add<A>(entity);
    world.add<B>(entity);
  }
  int counter = 0;  // the undeclared thing
  std::atomic<int> inside = 0;
  // Makes sure that both are under way at once; by itself it orders nothing that comes after.
  const auto meet = [&inside] {
    inside.fetch_add(1, std::memory_order_relaxed);
    while (inside.load(std::memory_order_relaxed) % 2 != 0) {
    }
  };
  Schedule schedule;
  schedule.add("left", [&](View<A> view) {
    meet();
    if (race) ++counter;
    each_in_parallel(view, 16, [](A& a) { ++a.value; });
  });
  schedule.add("right", [&](View<B> view) {
    meet();
    if (race) ++counter;
    each_in_parallel(view, 16, [](B& b) { ++b.value; });
  });
  parallel::WorkerArena arena(4);
  for (int frame = 0; frame < 20; ++frame) schedule.run(world, arena);
  std::printf("ran %d frames, counter %d\n", 20, counter);
}
