#include <gtest/gtest.h>

#include <atomic>
#include <stdexcept>
#include <string>

#include "engine/ecs/schedule.hpp"
#include "engine/parallel/for_range.hpp"

namespace fascicle::ecs {
namespace {

struct A {};
struct B {};
struct Clock {};

constexpr int kWorkerCounts[] = {1, 2, 3, 8};

std::string message_of_run(Schedule& schedule, World& world, int workers) {
  parallel::WorkerArena arena(workers);
  try {
    schedule.run(world, arena);
  } catch (const std::exception& error) {
    return error.what();
  }
  return {};
}

TEST(ScheduleError, SystemsThatWaitAndLaterStagesAreLeftOut) {
  for (const int workers : kWorkerCounts) {
    World world;
    Schedule schedule;
    std::atomic<int> independent = 0, waiting = 0, later = 0;
    schedule.add("fails", [](View<A>) { throw std::runtime_error("torn"); });
    schedule.add("independent", [&](View<B>) { ++independent; });
    schedule.add("waits", [&](View<const A>) { ++waiting; });
    schedule.add("waits for the one left out", [&](View<A>) { ++waiting; });
    schedule.add_barrier();
    schedule.add("later", [&](View<B>) { ++later; });
    EXPECT_EQ(message_of_run(schedule, world, workers), "torn");
    EXPECT_EQ(independent, 1) << workers;
    EXPECT_EQ(waiting, 0) << workers;
    EXPECT_EQ(later, 0) << workers;
    for (const std::size_t left_out : {2u, 3u, 4u}) {
      EXPECT_EQ(schedule.timings()[left_out].start_ns, schedule.timings()[left_out].end_ns);
    }
  }
}

TEST(ScheduleError, TheFirstInOrderOfRegistrationIsRethrown) {
  for (const int workers : kWorkerCounts) {
    World world;
    Schedule schedule;
    schedule.add("fine", [](View<A>) {});
    schedule.add("first", [](View<const A>) { throw std::runtime_error("first"); });
    schedule.add("second", [](View<B>) { throw std::runtime_error("second"); });
    EXPECT_EQ(message_of_run(schedule, world, workers), "first");
  }
}

TEST(ScheduleError, CommandsOfTheStageAreDropped) {
  for (const int workers : kWorkerCounts) {
    World world;
    Schedule schedule;
    bool fail = true;
    schedule.add("spawns", [](Commands& commands) { commands.create(); });
    schedule.add("fails", [&](View<A>) {
      if (fail) throw std::runtime_error("torn");
    });
    EXPECT_EQ(message_of_run(schedule, world, workers), "torn");
    EXPECT_EQ(world.entity_count(), 0u);
    fail = false;
    EXPECT_EQ(message_of_run(schedule, world, workers), "");  // and the next frame is whole again
    EXPECT_EQ(world.entity_count(), 1u);
  }
}

TEST(ScheduleError, ThrowingInsideAParallelLoopDoesNotHang) {
  for (const int workers : kWorkerCounts) {
    World world;
    Schedule schedule;
    schedule.add("fails", [](View<A>) {
      parallel::for_range(1000, 1, [](std::size_t begin, std::size_t) {
        if (begin == 500) throw std::runtime_error("chunk");
      });
    });
    schedule.add("other", [](View<B>) {});
    EXPECT_EQ(message_of_run(schedule, world, workers), "chunk");
    EXPECT_EQ(message_of_run(schedule, world, workers), "chunk");
  }
}

TEST(ScheduleError, MissingResourceIsReported) {
  for (const int workers : kWorkerCounts) {
    World world;
    Schedule schedule;
    schedule.add("tick", [](Resource<Clock>) {});
    schedule.add("other", [](View<B>) {});
    const std::string message = message_of_run(schedule, world, workers);
    EXPECT_NE(message.find("system tick needs the resource Clock"), std::string::npos) << message;
    world.set_resource(Clock{});
    EXPECT_EQ(message_of_run(schedule, world, workers), "");
  }
}

TEST(ScheduleError, ThrowingCommandComesOutAndTheWorldStaysUsable) {
  for (const int workers : kWorkerCounts) {
    World world;
    Schedule schedule;
    bool fail = true;
    schedule.add("fails", [&](Commands& commands) {
      if (fail) commands.run([](World&) { throw std::runtime_error("command"); });
    });
    schedule.add("spawns", [](Commands& commands) { commands.create(); });
    EXPECT_EQ(message_of_run(schedule, world, workers), "command");
    EXPECT_EQ(world.entity_count(), 0u);
    EXPECT_TRUE(world.alive(world.create()));
    fail = false;
    EXPECT_EQ(message_of_run(schedule, world, workers), "");
    EXPECT_EQ(world.entity_count(), 2u);
  }
}

}  // namespace
}  // namespace fascicle::ecs
