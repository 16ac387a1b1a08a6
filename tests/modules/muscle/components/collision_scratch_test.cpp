// Scratch that is lent: never to two at a time, and to any number of threads in turn.
#include "modules/muscle/components/collision_scratch.hpp"

#include <atomic>
#include <set>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "engine/parallel/worker_arena.hpp"
#include "tests/support/collision_rods.hpp"

namespace fascicle::muscle {
namespace {

TEST(CollisionScratch, OneAtATimeOnACore) {
  const CollisionScratch scratch;
  std::set<CollisionWork*> lent;
  std::vector<std::unique_ptr<CollisionScratch::Loan>> loans;
  for (int i = 0; i < parallel::hardware_workers(); ++i) {
    loans.push_back(std::make_unique<CollisionScratch::Loan>(scratch));
    lent.insert(&**loans.back());
  }
  EXPECT_EQ(lent.size(), loans.size());
  CollisionWork* const first = &**loans.front();
  loans.front().reset();
  EXPECT_EQ(&*CollisionScratch::Loan(scratch), first);  // what is given back is lent again
}

TEST(CollisionScratch, MoreThreadsThanThereIsScratchWaitForTheirTurn) {
  const CollisionScratch scratch;
  std::atomic<int> most{0}, now{0}, loans{0};
  std::atomic<bool> shared{false};
  std::vector<std::thread> threads;
  for (int i = 0; i < parallel::hardware_workers() + 6; ++i) {
    threads.emplace_back([&] {
      for (int k = 0; k < 200; ++k) {
        const CollisionScratch::Loan loan(scratch);
        int seen = most.load();
        const int here = ++now;
        while (here > seen && !most.compare_exchange_weak(seen, here)) {}
        // Nobody else may write here meanwhile.
        (*loan).cell = static_cast<float>(k);
        std::this_thread::yield();
        if ((*loan).cell != static_cast<float>(k)) shared = true;
        --now;
        ++loans;
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_FALSE(shared);
  EXPECT_LE(most.load(), parallel::hardware_workers());
  EXPECT_EQ(loans.load(), 200 * (parallel::hardware_workers() + 6));
}

TEST(CollisionScratch, RoomGrowsAndNeverShrinks) {
  CollisionScratch scratch;
  const std::size_t empty = scratch.heap_bytes();
  const auto rods = [](int count) {
    std::vector<test::Rod> list;
    for (int i = 0; i < count; ++i) {
      const float x = 0.1f * static_cast<float>(i);
      list.push_back({.from = {x, 0, 0}, .to = {x, 0, 0.1f}});
    }
    return test::build_collision(test::build_rods(list, 1), {nullptr});
  };
  scratch.reserve(*rods(4));
  const std::size_t large = scratch.heap_bytes();
  EXPECT_GT(large, empty);
  scratch.reserve(*rods(1));
  EXPECT_EQ(scratch.heap_bytes(), large);
}

}  // namespace
}  // namespace fascicle::muscle
