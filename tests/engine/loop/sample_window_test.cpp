#include "engine/loop/sample_window.hpp"

#include <gtest/gtest.h>

#include <deque>
#include <random>
#include <vector>

namespace fascicle {
namespace {

TEST(SampleWindow, EmptyHasNoValues) {
  EXPECT_TRUE(SampleWindow(4).values().empty());
  EXPECT_EQ(SampleWindow(0).capacity(), 1u);
}

TEST(SampleWindow, KeepsTheLastInOrderOfTime) {
  for (const std::size_t capacity : {1u, 2u, 7u}) {
    SampleWindow window(capacity);
    std::deque<float> expected;
    for (int i = 0; i < 30; ++i) {
      window.push(static_cast<float>(i));
      expected.push_back(static_cast<float>(i));
      if (expected.size() > capacity) expected.pop_front();
      EXPECT_EQ(std::vector<float>(window.values().begin(), window.values().end()),
                std::vector<float>(expected.begin(), expected.end()));
    }
  }
}

TEST(Percentile, OfNothingIsZero) { EXPECT_EQ(percentile({}, 50), 0.0F); }

TEST(Percentile, IsTheNearestRank) {
  struct Row {
    std::vector<float> sorted;
    double percent;
    float expected;
  };
  std::vector<float> hundred;
  for (int i = 1; i <= 100; ++i) hundred.push_back(static_cast<float>(i));
  const Row rows[] = {
      {{3}, 0, 3},          {{3}, 50, 3},         {{3}, 100, 3},
      {{1, 2}, 50, 1},      {{1, 2}, 51, 2},      {{1, 2, 3}, 50, 2},
      {hundred, 0, 1},      {hundred, 1, 1},      {hundred, 1.5, 2},
      {hundred, 50, 50},    {hundred, 95, 95},    {hundred, 99, 99},
      {hundred, 99.1, 100}, {hundred, 100, 100},  {{15, 20, 35, 40, 50}, 30, 20},
      {{15, 20, 35, 40, 50}, 40, 20},             {{15, 20, 35, 40, 50}, 50, 35},
  };
  for (const Row& row : rows) {
    EXPECT_EQ(percentile(row.sorted, row.percent), row.expected) << row.sorted.size() << " samples, " << row.percent;
  }
}

}  // namespace
}  // namespace fascicle
