#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <string>
#include <thread>
#include <vector>

#include "engine/ecs/each_in_parallel.hpp"
#include "engine/ecs/schedule.hpp"

namespace fascicle::ecs {
namespace {

struct A {
  int value = 0;
};
struct B {
  int value = 0;
};
struct C {
  int value = 0;
};
struct Log {
  std::vector<int> entries;
};

TEST(ScheduleRun, EmptyScheduleDoesNothing) {
  World world;
  Schedule schedule;
  for (const int workers : {1, 4}) {
    parallel::WorkerArena arena(workers);
    schedule.run(world, arena);
  }
  EXPECT_TRUE(schedule.timings().empty());
}

TEST(ScheduleRun, OneWorkerRunsInOrderOnTheCallingThread) {
  World world;
  Schedule schedule;
  std::vector<int> order;
  std::vector<std::thread::id> threads;
  const auto note = [&](int n) {
    order.push_back(n);
    threads.push_back(std::this_thread::get_id());
  };
  schedule.add("0", [&](View<A>) { note(0); });
  schedule.add("1", [&](View<B>) {
    // Loops inside stay on the thread, too.
    parallel::for_range(100, 1, [&](std::size_t, std::size_t) { threads.push_back(std::this_thread::get_id()); });
    note(1);
  });
  schedule.add("2", [&](View<A>) { note(2); });
  schedule.add_barrier();
  schedule.add("3", [&](View<C>) { note(3); });
  parallel::WorkerArena arena(1);
  schedule.run(world, arena);
  EXPECT_EQ(order, (std::vector<int>{0, 1, 2, 3}));
  EXPECT_EQ(threads, std::vector<std::thread::id>(104, std::this_thread::get_id()));
}

// Each waits until the other has begun: this ends only if they run at the same time, on any number of cores.
TEST(ScheduleRun, SystemsWithoutConflictRunSideBySide) {
  World world;
  Schedule schedule;
  std::atomic<int> arrived = 0;
  const auto meet = [&] {
    arrived.fetch_add(1);
    const auto patience = std::chrono::steady_clock::now() + std::chrono::seconds(60);
    while (arrived.load() < 4 && std::chrono::steady_clock::now() < patience) std::this_thread::yield();
  };
  schedule.add("0", [&](View<A>) { meet(); });
  schedule.add("1", [&](View<B>) { meet(); });
  schedule.add("2", [&](View<C>) { meet(); });
  schedule.add("3", [&](Resource<Log>) { meet(); });
  world.set_resource(Log{});
  parallel::WorkerArena arena(4);
  schedule.run(world, arena);
  EXPECT_EQ(arrived.load(), 4);
  std::vector<int> workers;
  for (const SystemTiming& timing : schedule.timings()) {
    EXPECT_GE(timing.worker, 0);
    EXPECT_LT(timing.worker, 4);
    for (const int other : workers) EXPECT_NE(timing.worker, other);
    workers.push_back(timing.worker);
  }
}

TEST(ScheduleRun, SystemsInConflictKeepTheirOrder) {
  for (const int workers : {1, 2, 8}) {
    World world;
    world.set_resource(Log{});
    Schedule schedule;
    for (int i = 0; i < 50; ++i) {
      schedule.add(std::to_string(i), [i](Resource<Log> log) { log->entries.push_back(i); });
    }
    parallel::WorkerArena arena(workers);
    schedule.run(world, arena);
    const std::vector<int>& entries = world.resource<Log>().entries;
    ASSERT_EQ(entries.size(), 50u);
    for (int i = 0; i < 50; ++i) EXPECT_EQ(entries[static_cast<std::size_t>(i)], i);
  }
}

TEST(ScheduleRun, CommandsAreCarriedOutAtBarriersInOrderOfRegistration) {
  for (const int workers : {1, 2, 8}) {
    World world;
    world.set_resource(Log{});
    Schedule schedule;
    for (int i = 0; i < 10; ++i) {
      schedule.add(std::to_string(i), [i](Commands& commands) {
        // Later systems are done sooner, so that the order of their ends differs from that of registration.
        if (i < 3) std::this_thread::sleep_for(std::chrono::milliseconds(3 - i));
        commands.run([i](World& w) { w.resource<Log>().entries.push_back(i); });
        const Entity entity = commands.create();
        commands.add<A>(entity, {i});
      });
    }
    int seen_in_stage = -1;
    schedule.add("same stage", [&](View<const A> view) { seen_in_stage = static_cast<int>(view.candidates()); });
    schedule.add_barrier();
    std::vector<int> seen_after;
    schedule.add("next stage", [&](View<const A> view) {
      view.each([&](const A& a) { seen_after.push_back(a.value); });
    });
    parallel::WorkerArena arena(workers);
    schedule.run(world, arena);
    const std::vector<int> expected{0, 1, 2, 3, 4, 5, 6, 7, 8, 9};
    EXPECT_EQ(seen_in_stage, 0);
    EXPECT_EQ(world.resource<Log>().entries, expected);
    EXPECT_EQ(seen_after, expected);
  }
}

TEST(ScheduleRun, CommandsAfterTheLastSystemAreCarriedOut) {
  World world;
  const Entity entity = world.create();
  world.add<A>(entity);
  Schedule schedule;
  schedule.add("remove", [](View<const A> view, Commands& commands) {
    view.each([&](Entity each, const A&) { commands.remove<A>(each); });
  });
  parallel::WorkerArena arena(1);
  schedule.run(world, arena);
  EXPECT_FALSE(world.has<A>(entity));
  EXPECT_TRUE(world.alive(entity));
}

TEST(ScheduleRun, TimingsCoverTheRun) {
  World world;
  Schedule schedule;
  schedule.add("first", [](View<A>) { std::this_thread::sleep_for(std::chrono::milliseconds(2)); });
  schedule.add("second", [](View<A>, Commands&) {});
  for (const int workers : {1, 2}) {
    parallel::WorkerArena arena(workers);
    schedule.run(world, arena);
    const std::span<const SystemTiming> timings = schedule.timings();
    ASSERT_EQ(timings.size(), 3u);
    EXPECT_GE(timings[0].end_ns - timings[0].start_ns, 2'000'000);
    EXPECT_GE(timings[1].start_ns, timings[0].end_ns);
    EXPECT_GE(timings[2].start_ns, timings[1].end_ns);
    EXPECT_GE(timings[2].end_ns, timings[2].start_ns);
  }
}

TEST(ScheduleRun, ScheduleMayGrowBetweenRunsAndMove) {
  World world;
  world.set_resource(Log{});
  Schedule schedule;
  parallel::WorkerArena arena(2);
  schedule.add("0", [](Resource<Log> log) { log->entries.push_back(0); });
  schedule.run(world, arena);
  schedule.add("1", [](Resource<Log> log) { log->entries.push_back(1); });
  Schedule moved = std::move(schedule);
  moved.run(world, arena);
  EXPECT_EQ(world.resource<Log>().entries, (std::vector<int>{0, 0, 1}));
}

}  // namespace
}  // namespace fascicle::ecs
