#include "engine/math/wide_trigonometry.hpp"

#include <array>
#include <cmath>

#include <gtest/gtest.h>

namespace {

using namespace fascicle::FASCICLE_ISA;

TEST(WideTrigonometry, SinesAndCosinesOverManyTurns) {
  for (int i = -200000; i <= 200000; i += 4) {
    std::array<float, 4> angles, sines, cosines;
    for (int n = 0; n < 4; ++n) angles[static_cast<std::size_t>(n)] = 0.0031f * static_cast<float>(i + n);
    WideFloat<4> sine, cosine;
    sine_cosine(load<4>(angles.data()), sine, cosine);
    store(sine, sines.data());
    store(cosine, cosines.data());
    for (std::size_t n = 0; n < 4; ++n) {
      ASSERT_NEAR(sines[n], std::sin(double{angles[n]}), 2.0e-7) << angles[n];
      ASSERT_NEAR(cosines[n], std::cos(double{angles[n]}), 2.0e-7) << angles[n];
    }
  }
}

TEST(WideTrigonometry, NearZeroGivesTheSameBits) {
  for (int i = -780; i <= 780; ++i) {
    WideFloat<4> sine, cosine, near_sine, near_cosine;
    sine_cosine(broadcast<4>(0.001f * static_cast<float>(i)), sine, cosine);
    sine_cosine_near_zero(broadcast<4>(0.001f * static_cast<float>(i)), near_sine, near_cosine);
    std::array<float, 4> a, b;
    store(sine, a.data());
    store(near_sine, b.data());
    EXPECT_EQ(a, b) << i;
    store(cosine, a.data());
    store(near_cosine, b.data());
    EXPECT_EQ(a, b) << i;
  }
}

TEST(WideTrigonometry, ArcTangentInAllQuadrants) {
  for (int i = 0; i < 3600; ++i) {
    const double angle = 0.1 * 3.14159265358979 / 180.0 * (i - 1800 + 0.5);
    const float y = static_cast<float>(0.37 * std::sin(angle)), x = static_cast<float>(0.37 * std::cos(angle));
    std::array<float, 4> result;
    store(arc_tangent(broadcast<4>(y), broadcast<4>(x)), result.data());
    ASSERT_NEAR(result[0], std::atan2(double{y}, double{x}), 3.0e-7) << angle;
  }
}

TEST(WideTrigonometry, ArcTangentOnTheAxes) {
  const std::array<float, 4> y = {0.0f, 1.0f, 0.0f, -2.0f}, x = {0.0f, 0.0f, -1.0f, 0.0f};
  std::array<float, 4> result;
  store(arc_tangent(load<4>(y.data()), load<4>(x.data())), result.data());
  EXPECT_EQ(result[0], 0.0f);
  EXPECT_NEAR(result[1], 1.57079633f, 1.0e-6f);
  EXPECT_NEAR(result[2], 3.14159265f, 1.0e-6f);
  EXPECT_NEAR(result[3], -1.57079633f, 1.0e-6f);
}

}  // namespace
