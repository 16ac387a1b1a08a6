#include "engine/parallel/for_range.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <mutex>
#include <set>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "engine/parallel/worker_arena.hpp"

namespace fascicle::parallel {
namespace {

constexpr int kWorkerCounts[] = {1, 2, 3, 8};

TEST(ForRange, EmptyRangeCallsNothing) {
  for_range(0, 1, [](std::size_t, std::size_t) { ADD_FAILURE(); });
  for_range(0, 0, [](std::size_t, std::size_t) { ADD_FAILURE(); });
}

TEST(ForRange, ChunkCount) {
  EXPECT_EQ(chunk_count(0, 4), 0u);
  EXPECT_EQ(chunk_count(1, 4), 1u);
  EXPECT_EQ(chunk_count(4, 4), 1u);
  EXPECT_EQ(chunk_count(5, 4), 2u);
  EXPECT_EQ(chunk_count(5, 0), 5u);
  EXPECT_EQ(chunk_count(~std::size_t{0}, 2), (~std::size_t{0}) / 2 + 1);
}

TEST(ForRange, OneChunkRunsInline) {
  int calls = 0;
  for_range(5, 5, [&](std::size_t begin, std::size_t end) {
    EXPECT_EQ(begin, 0u);
    EXPECT_EQ(end, 5u);
    ++calls;
  });
  EXPECT_EQ(calls, 1);
}

TEST(ForRange, ChunksAreFixedWhateverTheWorkers) {
  for (const int workers : kWorkerCounts) {
    WorkerArena arena(workers);
    std::mutex mutex;
    std::set<std::pair<std::size_t, std::size_t>> chunks;
    arena.execute([&] {
      for_range(103, 10, [&](std::size_t begin, std::size_t end) {
        const std::lock_guard lock(mutex);
        EXPECT_TRUE(chunks.emplace(begin, end).second);
      });
    });
    ASSERT_EQ(chunks.size(), 11u);
    for (std::size_t i = 0; i < 10; ++i) EXPECT_TRUE(chunks.contains({10 * i, 10 * i + 10}));
    EXPECT_TRUE(chunks.contains({100, 103}));
  }
}

TEST(ForRange, GrainOfZeroCountsAsOne) {
  std::vector<int> visits(20);
  for_range(visits.size(), 0, [&](std::size_t begin, std::size_t end) {
    EXPECT_EQ(end, begin + 1);
    ++visits[begin];
  });
  EXPECT_EQ(visits, std::vector<int>(20, 1));
}

TEST(ForRange, EveryElementOnceAlsoWhenNested) {
  for (const int workers : kWorkerCounts) {
    WorkerArena arena(workers);
    std::vector<int> visits(50 * 40);
    arena.execute([&] {
      for_range(50, 1, [&](std::size_t outer, std::size_t) {
        for_range(40, 3, [&](std::size_t begin, std::size_t end) {
          for (std::size_t i = begin; i < end; ++i) ++visits[outer * 40 + i];
        });
      });
    });
    EXPECT_EQ(visits, std::vector<int>(50 * 40, 1));
  }
}

TEST(ForRange, TheFirstChunksExceptionComesOutAndTheNextLoopWorks) {
  for (const int workers : kWorkerCounts) {
    WorkerArena arena(workers);
    arena.execute([&] {
      std::atomic<int> count = 0;
      try {
        for_range(100, 1, [&](std::size_t begin, std::size_t) {
          ++count;
          if (begin == 57 || begin == 31 || begin == 99) throw std::runtime_error(std::to_string(begin));
        });
        ADD_FAILURE() << "nothing came out";
      } catch (const std::runtime_error& error) {
        EXPECT_STREQ(error.what(), "31");
      }
      EXPECT_EQ(count, 100);
      for_range(100, 1, [&](std::size_t, std::size_t) { ++count; });
      EXPECT_EQ(count, 200);
    });
  }
}

// While a thread waits for the end of its inner loop it must not begin another iteration of the outer one.
TEST(ForRange, WaitingThreadTakesNoForeignWork) {
  WorkerArena arena(4);
  std::atomic<int> nested_in_own = 0;
  arena.execute([&] {
    for_range(64, 1, [&](std::size_t, std::size_t) {
      thread_local int depth = 0;
      if (depth != 0) ++nested_in_own;
      ++depth;
      for_range(64, 1, [](std::size_t, std::size_t) { std::this_thread::yield(); });
      --depth;
    });
  });
  EXPECT_EQ(nested_in_own, 0);
}

// Whatever the loop's body wrote is seen after it, and what was written before it is seen inside.
TEST(ForRange, HandsMemoryOver) {
  for (const int workers : kWorkerCounts) {
    WorkerArena arena(workers);
    std::vector<int> values(1000, 0);
    arena.execute([&] {
      for (int round = 1; round <= 20; ++round) {
        for (int& value : values) value += 1;
        for_range(values.size(), 10, [&](std::size_t begin, std::size_t end) {
          for (std::size_t i = begin; i < end; ++i) values[i] *= 1 + round % 2;
        });
      }
    });
    int expected = 0;
    for (int round = 1; round <= 20; ++round) expected = (expected + 1) * (1 + round % 2);
    EXPECT_EQ(values, std::vector<int>(1000, expected));
  }
}

}  // namespace
}  // namespace fascicle::parallel
