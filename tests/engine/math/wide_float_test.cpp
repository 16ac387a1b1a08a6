// The wide float of this file's instruction set (the baseline). The others are held against it, bit for bit, by the
// kernels' tests.
#include "engine/math/wide_float.hpp"

#include <array>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

namespace {

using namespace fascicle::FASCICLE_ISA;

template <class T>
class WideFloatTest : public testing::Test {};
template <int N>
struct Size {
  static constexpr int kCount = N;
};
using Sizes = testing::Types<Size<4>, Size<8>, Size<16>>;
TYPED_TEST_SUITE(WideFloatTest, Sizes);

template <int N>
std::array<float, N> ramp(float first, float step) {
  std::array<float, N> values;
  for (int i = 0; i < N; ++i) values[static_cast<std::size_t>(i)] = first + step * static_cast<float>(i);
  return values;
}

template <int N>
std::array<float, N> lanes_of(WideFloat<N> a) {
  std::array<float, N> values;
  store(a, values.data());
  return values;
}

TYPED_TEST(WideFloatTest, ArithmeticIsTheScalarOne) {
  constexpr int N = TypeParam::kCount;
  const auto a = ramp<N>(-3.3f, 0.7f), b = ramp<N>(0.9f, 1.3f);
  const WideFloat<N> x = load<N>(a.data()), y = load<N>(b.data());
  const auto sum = lanes_of(x + y), difference = lanes_of(x - y), product = lanes_of(x * y), quotient = lanes_of(x / y);
  const auto root = lanes_of(square_root(y)), low = lanes_of(minimum(x, y)), high = lanes_of(maximum(x, y));
  const auto size = lanes_of(absolute(x));
  for (std::size_t i = 0; i < N; ++i) {
    EXPECT_EQ(sum[i], a[i] + b[i]);
    EXPECT_EQ(difference[i], a[i] - b[i]);
    EXPECT_EQ(product[i], a[i] * b[i]);
    EXPECT_EQ(quotient[i], a[i] / b[i]);
    EXPECT_EQ(root[i], std::sqrt(b[i]));
    EXPECT_EQ(low[i], std::min(a[i], b[i]));
    EXPECT_EQ(high[i], std::max(a[i], b[i]));
    EXPECT_EQ(size[i], std::abs(a[i]));
  }
}

TYPED_TEST(WideFloatTest, InverseRootIsWithinAPartIn40000) {
  constexpr int N = TypeParam::kCount;
  float worst = 0.0f;
  for (float first = 1.0e-34f; first < 1.0e34f; first *= 1.37f) {
    const auto a = ramp<N>(first, 0.1f * first);
    const auto inverse = lanes_of(inverse_root(load<N>(a.data()), 3.0f));
    for (std::size_t i = 0; i < N; ++i) worst = std::max(worst, std::abs(inverse[i] * std::sqrt(a[i]) / 3.0f - 1.0f));
  }
  EXPECT_LT(worst, 2.5e-5f);
  EXPECT_TRUE(std::isfinite(lanes_of(inverse_root(broadcast<N>(0.0f), 3.0f))[0]));
}

TYPED_TEST(WideFloatTest, ShiftRightTakesZerosIn) {
  constexpr int N = TypeParam::kCount;
  std::array<int, N> bits;
  store_int(shift_right(broadcast_int<N>(-8), 1), bits.data());
  for (const int lane : bits) EXPECT_EQ(lane, 0x7ffffffc);
}

TYPED_TEST(WideFloatTest, SelectTakesLanesAndNaNsCompareFalse) {
  constexpr int N = TypeParam::kCount;
  auto a = ramp<N>(0.0f, 1.0f);
  a[1] = std::numeric_limits<float>::quiet_NaN();
  const WideFloat<N> x = load<N>(a.data());
  const auto chosen = lanes_of(select(x < broadcast<N>(2.5f), broadcast<N>(7.0f), broadcast<N>(9.0f)));
  for (std::size_t i = 0; i < N; ++i) EXPECT_EQ(chosen[i], i == 0 || i == 2 ? 7.0f : 9.0f) << i;
  EXPECT_TRUE(any(x < broadcast<N>(0.5f)));
  EXPECT_FALSE(any(x < broadcast<N>(-0.5f)));
}

TYPED_TEST(WideFloatTest, RoundsToEven) {
  constexpr int N = TypeParam::kCount;
  auto a = ramp<N>(0.0f, 0.0f);
  a[0] = 0.5f, a[1] = 1.5f, a[2] = -2.5f, a[3] = 511.49f;
  std::array<int, N> rounded;
  store_int(round_to_int(load<N>(a.data())), rounded.data());
  EXPECT_EQ(rounded[0], 0);
  EXPECT_EQ(rounded[1], 2);
  EXPECT_EQ(rounded[2], -2);
  EXPECT_EQ(rounded[3], 511);
}

TYPED_TEST(WideFloatTest, RecordsAreTheTransposedLanes) {
  constexpr int N = TypeParam::kCount;
  const auto x = ramp<N>(0.0f, 1.0f), y = ramp<N>(100.0f, 1.0f), z = ramp<N>(200.0f, 1.0f), w = ramp<N>(300.0f, 1.0f);
  alignas(64) std::array<float, 4 * N> records{}, streamed{};
  store_records<false>(load<N>(x.data()), load<N>(y.data()), load<N>(z.data()), load<N>(w.data()), records.data());
  store_records<true>(load<N>(x.data()), load<N>(y.data()), load<N>(z.data()), load<N>(w.data()), streamed.data());
  for (std::size_t i = 0; i < N; ++i) {
    EXPECT_EQ(records[4 * i], x[i]);
    EXPECT_EQ(records[4 * i + 1], y[i]);
    EXPECT_EQ(records[4 * i + 2], z[i]);
    EXPECT_EQ(records[4 * i + 3], w[i]);
  }
  EXPECT_EQ(records, streamed);
}

TYPED_TEST(WideFloatTest, SumsFromFirstToLast) {
  constexpr int N = TypeParam::kCount;
  auto a = ramp<N>(0.1f, 0.3f);
  a[0] = 1.0e8f;
  a[N - 1] = -1.0e8f;
  float expected = a[0];
  for (std::size_t i = 1; i < N; ++i) expected += a[i];
  EXPECT_EQ(sum_in_order(load<N>(a.data())), expected);
}

}  // namespace
