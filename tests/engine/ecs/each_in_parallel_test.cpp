#include "engine/ecs/each_in_parallel.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "engine/ecs/world.hpp"
#include "engine/parallel/worker_arena.hpp"

namespace fascicle::ecs {
namespace {

struct A {
  int value = 0;
  int visits = 0;
};
struct B {
  int value = 0;
};

TEST(EachInParallel, EmptyViewCallsNothing) {
  World world;
  each_in_parallel(world.view<A>(), 1, [](A&) { ADD_FAILURE(); });
}

TEST(EachInParallel, VisitsEveryMatchOnce) {
  for (const int workers : {1, 2, 8}) {
    World world;
    std::vector<Entity> entities;
    for (int i = 0; i < 1000; ++i) {
      entities.push_back(world.create());
      world.add<A>(entities.back(), {i, 0});
      if (i % 3 == 0) world.add<B>(entities.back(), {i});
    }
    parallel::WorkerArena arena(workers);
    arena.execute([&] {
      each_in_parallel(world.view<A, const B>(), 7, [](A& a, const B& b) {
        a.value += b.value;
        ++a.visits;
      });
      each_in_parallel(world.view<A>(), 7, [&](Entity entity, A& a) {
        if (entity == entities[5]) a.value = -1;
      });
    });
    for (int i = 0; i < 1000; ++i) {
      const A& a = world.get<A>(entities[static_cast<std::size_t>(i)]);
      EXPECT_EQ(a.visits, i % 3 == 0 ? 1 : 0);
      EXPECT_EQ(a.value, i == 5 ? -1 : i % 3 == 0 ? 2 * i : i);
    }
  }
}

}  // namespace
}  // namespace fascicle::ecs
