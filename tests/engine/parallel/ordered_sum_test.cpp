#include "engine/parallel/ordered_sum.hpp"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "engine/parallel/worker_arena.hpp"

namespace fascicle::parallel {
namespace {

struct Pair {
  float a = 0;
  double b = 0;
  Pair& operator+=(const Pair& other) {
    a += other.a;
    b += other.b;
    return *this;
  }
};

// Terms of mixed signs and sizes: any other order of summation gives other bits.
std::vector<float> terms(std::size_t count) {
  std::vector<float> result(count);
  for (std::size_t i = 0; i < count; ++i) {
    result[i] = std::sin(static_cast<float>(i) * 12.9898F) * std::exp2(static_cast<float>(i % 20));
  }
  return result;
}

float sum_range(const std::vector<float>& values, std::size_t begin, std::size_t end) {
  float sum = 0;
  for (std::size_t i = begin; i < end; ++i) sum += values[i];
  return sum;
}

TEST(OrderedSum, OfNothingIsZero) {
  EXPECT_EQ(ordered_sum(0, 10, [](std::size_t, std::size_t) { return 1.0F; }), 0.0F);
}

TEST(OrderedSum, OfIntegersIsExact) {
  const auto count = [](std::size_t begin, std::size_t end) { return end - begin; };
  EXPECT_EQ(ordered_sum(1001, 10, count), 1001u);
  EXPECT_EQ(ordered_sum(5, 0, count), 5u);
  EXPECT_EQ(ordered_sum(5, 100, count), 5u);
}

TEST(OrderedSum, GivesTheSameBitsForAnyNumberOfWorkers) {
  const std::vector<float> values = terms(10007);
  // By the definition: chunk sums, added in order.
  float expected = sum_range(values, 0, 64);
  for (std::size_t begin = 64; begin < values.size(); begin += 64) {
    expected += sum_range(values, begin, std::min<std::size_t>(begin + 64, values.size()));
  }
  EXPECT_NE(std::bit_cast<std::uint32_t>(expected), std::bit_cast<std::uint32_t>(sum_range(values, 0, values.size())))
      << "the terms do not tell orders apart";
  for (const int workers : {1, 2, 3, 8}) {
    WorkerArena arena(workers);
    for (int repeat = 0; repeat < 20; ++repeat) {
      float sum = 0;
      arena.execute([&] {
        sum = ordered_sum(values.size(), 64, [&](std::size_t b, std::size_t e) { return sum_range(values, b, e); });
      });
      ASSERT_EQ(std::bit_cast<std::uint32_t>(sum), std::bit_cast<std::uint32_t>(expected)) << workers;
    }
  }
}

TEST(OrderedSum, SumsAnyTypeIntoGivenMemory) {
  std::vector<Pair> partial(11, Pair{99, 99});
  const Pair sum = ordered_sum(100, 10, std::span<Pair>(partial), [](std::size_t begin, std::size_t end) {
    return Pair{static_cast<float>(end - begin), static_cast<double>(begin)};
  });
  EXPECT_EQ(sum.a, 100.0F);
  EXPECT_EQ(sum.b, 450.0);
  EXPECT_EQ(partial[10].a, 99.0F);  // beyond the chunks: untouched
}

}  // namespace
}  // namespace fascicle::parallel
