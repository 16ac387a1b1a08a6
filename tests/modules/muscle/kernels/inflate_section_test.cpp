#include "modules/muscle/kernels/inflate_section.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace fascicle::muscle {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

using Flags = std::vector<std::uint8_t>;

// By the polygon's corners, with nothing of the kernel's own.
double shoelace(const std::vector<float>& radii) {
  const double step = 2.0 * std::numbers::pi / static_cast<double>(radii.size());
  double area = 0.0;
  for (std::size_t i = 0; i < radii.size(); ++i) {
    const std::size_t j = (i + 1) % radii.size();
    const double a = step * static_cast<double>(i), b = step * static_cast<double>(j);
    area += 0.5 * radii[i] * radii[j] * (std::cos(a) * std::sin(b) - std::sin(a) * std::cos(b));
  }
  return area;
}

// A muscle's section that is not round, cm sized.
std::vector<float> oval(std::size_t count) {
  std::vector<float> radii(count);
  for (std::size_t i = 0; i < count; ++i) {
    const double theta = 2.0 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(count);
    radii[i] = static_cast<float>(0.02 + 0.005 * std::cos(2.0 * theta) + 0.002 * std::sin(theta));
  }
  return radii;
}

// Clips the section against the plane x = depth; what it clips is fixed.
Flags press(double depth, std::vector<float>& radii) {
  Flags fixed(radii.size(), 0);
  for (std::size_t i = 0; i < radii.size(); ++i) {
    const double cosine = std::cos(2.0 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(radii.size()));
    if (radii[i] * cosine <= depth) continue;
    radii[i] = static_cast<float>(depth / cosine);
    fixed[i] = 1;
  }
  return fixed;
}

void expect_unchanged(std::vector<float> radii, const Flags& fixed, float target, Inflation kind) {
  const std::vector<float> before = radii;
  const InflateOutcome outcome = inflate_section(radii, fixed, target, 2.0f);
  EXPECT_EQ(outcome.kind, kind);
  EXPECT_EQ(outcome.scale, 1.0f);
  EXPECT_TRUE(std::equal(radii.begin(), radii.end(), before.begin(), [](float a, float b) {
    return a == b || (std::isnan(a) && std::isnan(b));
  }));
}

TEST(InflateSection, WhatIsNotFiniteStays) {
  const Flags fixed = {1, 0, 0, 0, 0, 0};
  for (const float bad : {kNan, kInfinity, -kInfinity}) {
    for (std::size_t place : {0, 2}) {
      std::vector<float> radii = oval(6);
      radii[place] = bad;
      expect_unchanged(radii, fixed, 1e-3f, Inflation::kNoRoot);
    }
    expect_unchanged(oval(6), fixed, bad, Inflation::kNoRoot);
  }
}

TEST(InflateSection, NoPolygonNoChange) {
  expect_unchanged({}, {}, 1e-3f, Inflation::kNoRoot);
  expect_unchanged({0.01f}, {0}, 1e-3f, Inflation::kNoRoot);
  expect_unchanged({0.01f, 0.01f}, {0, 0}, 1e-3f, Inflation::kNoRoot);
  EXPECT_EQ(section_area({}), 0.0f);
  EXPECT_EQ(section_area(std::vector<float>{1.0f, 1.0f}), 0.0f);
}

TEST(InflateSection, AllFixed) { expect_unchanged(oval(8), Flags(8, 1), 1e-2f, Inflation::kAllFixed); }

TEST(InflateSection, FreeRadiiOfZeroHaveNoScale) {
  expect_unchanged(std::vector<float>(8, 0.0f), Flags(8, 0), 1e-3f, Inflation::kNoRoot);
  expect_unchanged({0.0f, 0.01f, 0.01f, 0.01f, 0.01f, 0.01f}, {0, 1, 1, 1, 1, 1}, 1e-3f, Inflation::kNoRoot);
}

TEST(InflateSection, NegativeRadiiThatCannotReachTheAreaStay) {
  // Opposite signs side by side: every product is negative, and growing only takes area away.
  expect_unchanged({0.01f, -0.01f, 0.01f, -0.01f, 0.01f, -0.01f}, Flags(6, 0), 1e-4f, Inflation::kNoRoot);
}

TEST(InflateSection, AreaIsThePolygons) {
  for (std::size_t count = 6; count <= 36; ++count) {
    const std::vector<float> radii = oval(count);
    EXPECT_NEAR(section_area(radii), shoelace(radii), 1e-7 * shoelace(radii)) << count;
  }
  EXPECT_NEAR(section_area(std::vector<float>(4, 1.0f)), 2.0, 1e-6);
  EXPECT_NEAR(section_area(std::vector<float>(6, -1.0f)), 1.5 * std::sqrt(3.0), 1e-6);
  EXPECT_NEAR(section_area(std::vector<float>(256, 1.0f)), std::numbers::pi, 1e-3);
}

// The project's inflation test (thesis 4.2.1).
TEST(InflateSection, PressedByAPlaneKeepsItsAreaAndItsShape) {
  for (std::size_t count = 6; count <= 36; count += 2) {
    const std::vector<float> rest = oval(count);
    const float target = section_area(rest);
    for (const double depth : {0.024, 0.02, 0.015, 0.01, 0.005, 0.001}) {
      std::vector<float> radii = rest;
      const Flags fixed = press(depth, radii);
      const std::vector<float> pressed = radii;
      ASSERT_LT(section_area(pressed), 0.9999f * target);
      const InflateOutcome outcome = inflate_section(radii, fixed, target, 4.0f);
      ASSERT_EQ(outcome.kind, Inflation::kReached) << count << " vertices, plane at " << depth;
      EXPECT_GT(outcome.scale, 1.0f);
      EXPECT_NEAR(shoelace(radii), target, 1e-5 * target) << count << " vertices, plane at " << depth;
      for (std::size_t i = 0; i < count; ++i) {
        EXPECT_NEAR(radii[i], pressed[i] * (fixed[i] != 0 ? 1.0f : outcome.scale), 1e-6f * radii[i]) << i;
      }
    }
  }
}

TEST(InflateSection, AtItsAreaItStaysBitForBit) {
  for (std::size_t count = 6; count <= 36; count += 2) {
    std::vector<float> radii = oval(count);
    const std::vector<float> rest = radii;
    EXPECT_EQ(inflate_section(radii, Flags(count, 0), section_area(rest), 2.0f).kind, Inflation::kReached);
    EXPECT_EQ(radii, rest) << count;
  }
}

TEST(InflateSection, ShrinksToo) {
  std::vector<float> radii(8, 0.02f);
  const float target = 0.25f * section_area(radii);
  EXPECT_EQ(inflate_section(radii, Flags(8, 0), target, 4.0f).kind, Inflation::kReached);
  for (const float radius : radii) EXPECT_NEAR(radius, 0.01f, 1e-8f);
}

TEST(InflateSection, TheCapHoldsBothWays) {
  std::vector<float> radii(8, 0.02f);
  const float area = section_area(radii);
  InflateOutcome outcome = inflate_section(radii, Flags(8, 0), 100.0f * area, 1.5f);
  EXPECT_EQ(outcome.kind, Inflation::kCapped);
  for (const float radius : radii) EXPECT_FLOAT_EQ(radius, 0.03f);
  outcome = inflate_section(radii, Flags(8, 0), 0.0f, 1.5f);
  EXPECT_EQ(outcome.kind, Inflation::kCapped);
  for (const float radius : radii) EXPECT_FLOAT_EQ(radius, 0.02f);
}

TEST(InflateSection, FixedRadiiAboveTheTargetShrinkTheFreeToTheCap) {
  std::vector<float> radii(8, 0.02f);
  Flags fixed(8, 1);
  fixed[3] = fixed[4] = 0;
  const InflateOutcome outcome = inflate_section(radii, fixed, 0.1f * section_area(radii), 2.0f);
  EXPECT_EQ(outcome.kind, Inflation::kCapped);
  EXPECT_EQ(outcome.scale, 0.5f);
  EXPECT_FLOAT_EQ(radii[3], 0.01f);
  EXPECT_FLOAT_EQ(radii[0], 0.02f);
}

TEST(InflateSection, NegativeRadiiCountAlgebraically) {
  std::vector<float> radii = oval(12);
  radii[3] = -0.004f;
  radii[4] = -0.002f;
  Flags fixed(12, 0);
  fixed[4] = fixed[5] = 1;
  const std::vector<float> before = radii;
  const float target = 1.2f * static_cast<float>(shoelace(oval(12)));
  const InflateOutcome outcome = inflate_section(radii, fixed, target, 4.0f);
  EXPECT_EQ(outcome.kind, Inflation::kReached);
  EXPECT_NEAR(shoelace(radii), target, 1e-5 * target);
  EXPECT_FLOAT_EQ(radii[3], outcome.scale * before[3]);
  EXPECT_EQ(radii[4], before[4]);
}

// Against a search for the scale over the polygon's corners.
TEST(InflateSection, AgreesWithASearch) {
  std::mt19937 random(7);
  std::uniform_real_distribution<float> radius(0.001f, 0.03f), change(0.5f, 2.0f);
  std::bernoulli_distribution is_fixed(0.3);
  int reached = 0;
  for (int trial = 0; trial < 400; ++trial) {
    const std::size_t count = 6 + 2 * (trial % 16);
    std::vector<float> radii(count);
    Flags fixed(count);
    for (std::size_t i = 0; i < count; ++i) {
      radii[i] = radius(random);
      fixed[i] = is_fixed(random) ? 1 : 0;
    }
    fixed[0] = fixed[1] = 0;
    const auto scaled = [&](double scale) {
      std::vector<float> result = radii;
      for (std::size_t i = 0; i < count; ++i) {
        if (fixed[i] == 0) result[i] = static_cast<float>(radii[i] * scale);
      }
      return result;
    };
    const float target = section_area(radii) * change(random);
    double low = 0.0, high = 100.0;  // positive radii: the area grows with the scale
    for (int i = 0; i < 60; ++i) {
      const double middle = 0.5 * (low + high);
      (shoelace(scaled(middle)) < target ? low : high) = middle;
    }
    const std::vector<float> expected = scaled(std::clamp(low, 1.0 / 3.0, 3.0));
    const InflateOutcome outcome = inflate_section(radii, fixed, target, 3.0f);
    if (outcome.kind == Inflation::kReached) {
      ++reached;
      EXPECT_NEAR(shoelace(radii), target, 1e-5 * target);
    } else {
      EXPECT_EQ(outcome.kind, Inflation::kCapped);
    }
    for (std::size_t i = 0; i < count; ++i) EXPECT_NEAR(radii[i], expected[i], 2e-6f * expected[i]) << trial;
  }
  EXPECT_GT(reached, 200);
}

TEST(InflateIteratively, ReachesTheSameRadii) {
  for (std::size_t count = 6; count <= 36; count += 6) {
    const std::vector<float> rest = oval(count);
    const float target = section_area(rest);
    for (const double depth : {0.02, 0.01, 0.001}) {
      std::vector<float> closed = rest;
      const Flags fixed = press(depth, closed);
      std::vector<float> iterated = closed;
      ASSERT_EQ(inflate_section(closed, fixed, target, 4.0f).kind, Inflation::kReached);
      const IterativeInflation result = inflate_iteratively(iterated, fixed, target, 1e-5f, 200);
      EXPECT_TRUE(result.converged) << count << " vertices, plane at " << depth;
      EXPECT_GT(result.iterations, 0u);
      for (std::size_t i = 0; i < count; ++i) EXPECT_NEAR(iterated[i], closed[i], 1e-4f * closed[i]) << i;
      EXPECT_LE(shoelace(iterated), target * (1.0 + 1e-6));
    }
  }
}

// Its table of 8, 4 and 6 iterations is for tolerances of a tenth to a 250th of the area.
TEST(InflateIteratively, TakesAFewIterationsForTheThesissTolerance) {
  const std::vector<float> rest = oval(8);
  std::vector<float> radii = rest;
  const Flags fixed = press(0.02, radii);
  const IterativeInflation result = inflate_iteratively(radii, fixed, section_area(rest), 1.0f / 190.0f, 200);
  EXPECT_TRUE(result.converged);
  EXPECT_GE(result.iterations, 2u);
  EXPECT_LE(result.iterations, 12u);
}

TEST(InflateIteratively, StopsWhereItMust) {
  std::vector<float> radii = oval(8);
  const std::vector<float> rest = radii;
  const float area = section_area(rest);
  EXPECT_FALSE(inflate_iteratively(radii, Flags(8, 1), 2.0f * area, 1e-4f, 100).converged);
  EXPECT_EQ(inflate_iteratively(radii, Flags(8, 0), kNan, 1e-4f, 100).iterations, 0u);
  EXPECT_EQ(inflate_iteratively(radii, Flags(8, 0), 0.5f * area, 1e-4f, 100).iterations, 0u);
  EXPECT_EQ(radii, rest);
  EXPECT_EQ(inflate_iteratively(radii, Flags(8, 0), 100.0f * area, 1e-4f, 5).iterations, 5u);
  EXPECT_GT(section_area(radii), area);
}

}  // namespace
}  // namespace fascicle::muscle
