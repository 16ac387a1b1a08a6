#include <gtest/gtest.h>

#include <cstdint>
#include <new>
#include <thread>

#include "engine/ecs/each_in_parallel.hpp"
#include "engine/ecs/schedule.hpp"
#include "tests/support/allocation_counter.hpp"

namespace fascicle::ecs {
namespace {

struct alignas(64) Wide {
  float values[16] = {};
};
template <int N>
struct Slot {
  float value = 0;
};

// Through a volatile, or the compiler is free to leave out an allocation that nobody looks at.
template <class T>
T* kept(T* pointer) {
  T* volatile result = pointer;
  return result;
}

TEST(AllocationCounter, CountsEveryFormOfNew) {
  const test::AllocationScope scope;
  delete kept(new int);
  EXPECT_EQ(scope.allocations(), 1u);
  delete[] kept(new int[3]);
  EXPECT_EQ(scope.allocations(), 2u);
  Wide* wide = kept(new Wide);
  EXPECT_EQ(reinterpret_cast<std::uintptr_t>(wide) % 64, 0u);
  delete wide;
  EXPECT_EQ(scope.allocations(), 3u);
  ::operator delete(kept(::operator new(8, std::nothrow)), std::nothrow);
  EXPECT_EQ(scope.allocations(), 4u);
  void* aligned = kept(::operator new(100, std::align_val_t(32), std::nothrow));
  ::operator delete(aligned, std::align_val_t(32), std::nothrow);
  EXPECT_EQ(scope.allocations(), 5u);
  const std::uint64_t before = test::deallocation_count();
  std::thread([] { delete kept(new int); }).join();
  EXPECT_GE(scope.allocations(), 6u);
  EXPECT_GE(test::deallocation_count(), before + 1);
}

template <int N>
void spread(View<Slot<N>> view) {
  each_in_parallel(view, 16, [](Slot<N>& slot) { slot.value += 1; });
}
template <int From, int To>
void move(View<const Slot<From>, Slot<To>> view) {
  view.each([](const Slot<From>& from, Slot<To>& to) { to.value += from.value; });
}

// A frame with loops, chains, independent systems and a barrier.
TEST(ScheduleAllocation, SteadyFramesAllocateNothing) {
  for (const int workers : {1, 4}) {
    World world;
    for (int i = 0; i < 500; ++i) {
      const Entity entity = world.create();
      world.add<Slot<0>>(entity, {1});
      world.add<Slot<1>>(entity);
      world.add<Slot<2>>(entity);
      world.add<Slot<3>>(entity);
    }
    Schedule schedule;
    schedule.add("spread 0", spread<0>);
    schedule.add("spread 1", spread<1>);
    schedule.add("0 to 2", move<0, 2>);
    schedule.add("1 to 3", move<1, 3>);
    schedule.add("spread 2", spread<2>);
    schedule.add_barrier();
    schedule.add("2 to 0", move<2, 0>);
    schedule.add("commands", [](View<const Slot<0>>, Commands&) {});
    parallel::WorkerArena arena(workers);
    for (int frame = 0; frame < 50; ++frame) schedule.run(world, arena);
    const test::AllocationScope scope;
    for (int frame = 0; frame < 200; ++frame) schedule.run(world, arena);
    EXPECT_EQ(scope.allocations(), 0u) << workers << " workers";
  }
}

}  // namespace
}  // namespace fascicle::ecs
