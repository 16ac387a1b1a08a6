#include "engine/render/range_allocator.hpp"

#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace fascicle {
namespace {

TEST(RangeAllocator, EmptyHasNoRoom) {
  RangeAllocator ranges;
  EXPECT_FALSE(ranges.allocate(1).has_value());
  EXPECT_EQ(ranges.allocate(0), 0u);
}

TEST(RangeAllocator, FirstFitAndJoiningOfNeighbours) {
  RangeAllocator ranges;
  ranges.grow(10);
  EXPECT_EQ(ranges.allocate(4), 0u);
  EXPECT_EQ(ranges.allocate(4), 4u);
  EXPECT_FALSE(ranges.allocate(4).has_value());
  ranges.release(0, 4);
  EXPECT_EQ(ranges.allocate(3), 0u);
  ranges.release(4, 4);
  EXPECT_EQ(ranges.allocate(7), 3u) << "3, 4..7 and 8..9 are one range";
}

TEST(RangeAllocator, GrowingJoinsTheFreeEnd) {
  RangeAllocator ranges;
  ranges.grow(4);
  EXPECT_EQ(ranges.allocate(2), 0u);
  ranges.grow(8);
  EXPECT_EQ(ranges.allocate(6), 2u);
}

TEST(RangeAllocator, RandomUseNeverOverlapsAndEndsWhole) {
  RangeAllocator ranges;
  ranges.grow(1000);
  std::vector<int> owner(1000, -1);
  struct Held {
    std::uint32_t first, count;
  };
  std::vector<Held> held;
  std::mt19937 random(7);
  for (int round = 0; round < 5000; ++round) {
    if (held.empty() || random() % 2 == 0) {
      const std::uint32_t count = 1 + random() % 60;
      const auto first = ranges.allocate(count);
      if (!first) continue;
      for (std::uint32_t i = 0; i < count; ++i) {
        ASSERT_EQ(owner[*first + i], -1);
        owner[*first + i] = round;
      }
      held.push_back({*first, count});
    } else {
      const std::size_t which = random() % held.size();
      for (std::uint32_t i = 0; i < held[which].count; ++i) owner[held[which].first + i] = -1;
      ranges.release(held[which].first, held[which].count);
      held.erase(held.begin() + static_cast<std::ptrdiff_t>(which));
    }
  }
  for (const Held& range : held) ranges.release(range.first, range.count);
  EXPECT_EQ(ranges.free_count(), 1000u);
  EXPECT_EQ(ranges.allocate(1000), 0u);
}

}  // namespace
}  // namespace fascicle
