#include "engine/parallel/worker_arena.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <memory>
#include <stdexcept>
#include <thread>
#include <vector>

#include "engine/parallel/for_range.hpp"

namespace fascicle::parallel {
namespace {

// The most chunks of a loop that were under way at once: each waits until `wanted` are, or patience ends.
int most_at_once(WorkerArena& arena, int wanted, std::chrono::milliseconds patience) {
  std::atomic<int> inside = 0, most = 0;
  const auto end = std::chrono::steady_clock::now() + patience;
  arena.execute([&] {
    for_range(64, 1, [&](std::size_t, std::size_t) {
      const int now = inside.fetch_add(1) + 1;
      int seen = most.load();
      while (seen < now && !most.compare_exchange_weak(seen, now)) {
      }
      while (most.load() < wanted && std::chrono::steady_clock::now() < end) std::this_thread::yield();
      inside.fetch_sub(1);
    });
  });
  return most;
}

TEST(WorkerArena, ZeroAsksForOneWorkerACore) {
  EXPECT_GE(hardware_workers(), 1);
  EXPECT_EQ(WorkerArena(0).workers(), hardware_workers());
}

TEST(WorkerArena, HasTheWorkersAskedForOnAnyNumberOfCores) {
  for (const int workers : {1, 2, 3, 8}) {
    WorkerArena arena(workers);
    EXPECT_EQ(arena.workers(), workers);
    EXPECT_EQ(most_at_once(arena, workers, std::chrono::seconds(60)), workers);
  }
}

TEST(WorkerArena, HasNoMoreThanAskedFor) {
  for (const int workers : {1, 2, 3}) {
    WorkerArena arena(workers);
    EXPECT_EQ(most_at_once(arena, workers + 1, std::chrono::milliseconds(50)), workers);
  }
}

TEST(WorkerArena, ArenasOfDifferentSizesLiveSideBySide) {
  WorkerArena one(1), eight(8), three(3);
  EXPECT_EQ(most_at_once(one, 1, std::chrono::seconds(60)), 1);
  EXPECT_EQ(most_at_once(eight, 8, std::chrono::seconds(60)), 8);
  EXPECT_EQ(most_at_once(three, 3, std::chrono::seconds(60)), 3);
}

TEST(WorkerArena, ExecuteRunsOnTheCallingThread) {
  EXPECT_EQ(current_worker(), 0);
  for (const int workers : {1, 4}) {
    WorkerArena arena(workers);
    std::thread::id inside;
    int worker = -1;
    arena.execute([&] {
      inside = std::this_thread::get_id();
      worker = current_worker();
      arena.execute([&] { EXPECT_EQ(current_worker(), worker); });
    });
    EXPECT_EQ(inside, std::this_thread::get_id());
    EXPECT_GE(worker, 0);
    EXPECT_LT(worker, workers);
  }
}

TEST(WorkerArena, ExceptionsComeOut) {
  WorkerArena arena(2);
  EXPECT_THROW(arena.execute([] { throw std::runtime_error("out"); }), std::runtime_error);
  bool ran = false;
  arena.execute([&] { ran = true; });
  EXPECT_TRUE(ran);
}

TEST(WorkerArena, TakesMoveOnlyAndConstCallables) {
  WorkerArena arena(1);
  int sum = 0;
  auto owned = std::make_unique<int>(3);
  arena.execute([&sum, owned = std::move(owned)]() mutable { sum += *owned; });
  const auto constant = [&sum] { sum += 4; };
  arena.execute(constant);
  EXPECT_EQ(sum, 7);
}

}  // namespace
}  // namespace fascicle::parallel
