// Matches and their cyclic order (2.2): the method's table, and every pattern of signs and misses against a definition
// by brute force.
#include "modules/muscle/asset/fit/match_order.hpp"

#include <algorithm>

#include <gtest/gtest.h>

namespace fascicle::muscle {
namespace {

std::vector<std::uint32_t> order(const std::vector<double>& radii, const std::vector<std::uint8_t>& hits) {
  std::vector<std::uint32_t> ordered{99};
  order_matches(radii, hits, ordered);
  return ordered;
}

// Every pair is a match; pair i has the sign of d_i at vertex i.
std::vector<std::uint32_t> order_signs(const std::vector<int>& signs) {
  const std::size_t half = signs.size();
  std::vector<double> radii(2 * half);
  for (std::size_t i = 0; i < half; ++i) {
    radii[i] = signs[i];
    radii[i + half] = -signs[i];
  }
  return order(radii, std::vector<std::uint8_t>(2 * half, 1));
}

// By its meaning: of all rotations of the sorted matches, the one that turns through the least from first to last; of
// several, the one whose last is the lowest.
std::vector<std::uint32_t> order_by_turning(const std::vector<double>& radii, const std::vector<std::uint8_t>& hits) {
  const std::uint32_t count = static_cast<std::uint32_t>(radii.size());
  std::vector<std::uint32_t> matches;
  for (std::uint32_t i = 0; i < count; ++i) {
    const std::uint32_t o = i < count / 2 ? i + count / 2 : i - count / 2;
    const bool exactly_one_negative = (radii[i] < 0.0) != (radii[o] < 0.0);
    if (hits[i] && hits[o] && exactly_one_negative && !(radii[i] < 0.0)) matches.push_back(i);
  }
  std::vector<std::uint32_t> best = matches;
  std::uint32_t least = 2 * count, lowest_last = count;
  for (std::size_t first = 0; first < matches.size(); ++first) {
    std::vector<std::uint32_t> rotated;
    std::uint32_t turn = 0;
    for (std::size_t j = 0; j < matches.size(); ++j) rotated.push_back(matches[(first + j) % matches.size()]);
    for (std::size_t j = 1; j < rotated.size(); ++j) turn += (rotated[j] + count - rotated[j - 1]) % count;
    if (turn > least || (turn == least && rotated.back() > lowest_last)) continue;
    least = turn;
    lowest_last = rotated.back();
    best = rotated;
  }
  return best;
}

TEST(MatchOrder, NoRaysNoMatches) { EXPECT_TRUE(order({}, {}).empty()); }

TEST(MatchOrder, APairThatFoundTheSurfaceOnBothSidesIsNoMatch) {
  EXPECT_TRUE(order({1, 1, 1, 1, 1, 1}, {1, 1, 1, 1, 1, 1}).empty());
  EXPECT_TRUE(order({-1, -1, -1, -1, -1, -1}, {1, 1, 1, 1, 1, 1}).empty());
  EXPECT_TRUE(order({0, 0, 0, 0, 0, 0}, {1, 1, 1, 1, 1, 1}).empty());
}

TEST(MatchOrder, AMissBreaksTheMatch) {
  EXPECT_EQ(order({1, 1, 1, -1, -1, -1}, {1, 1, 1, 1, 0, 1}), (std::vector<std::uint32_t>{0, 2}));
  EXPECT_TRUE(order({1, 1, 1, -1, -1, -1}, {0, 1, 1, 1, 0, 0}).empty());
}

TEST(MatchOrder, IsTheMethodsTableForSixVertices) {
  EXPECT_EQ(order_signs({+1, +1, +1}), (std::vector<std::uint32_t>{0, 1, 2}));
  EXPECT_EQ(order_signs({+1, +1, -1}), (std::vector<std::uint32_t>{5, 0, 1}));
  EXPECT_EQ(order_signs({+1, -1, -1}), (std::vector<std::uint32_t>{4, 5, 0}));
  EXPECT_EQ(order_signs({-1, -1, -1}), (std::vector<std::uint32_t>{3, 4, 5}));
  EXPECT_EQ(order_signs({-1, -1, +1}), (std::vector<std::uint32_t>{2, 3, 4}));
  EXPECT_EQ(order_signs({-1, +1, +1}), (std::vector<std::uint32_t>{1, 2, 3}));
}

TEST(MatchOrder, OfEqualGapsThatAfterTheLowestCounts) {
  EXPECT_EQ(order_signs({+1, -1, +1}), (std::vector<std::uint32_t>{2, 4, 0}));
  EXPECT_EQ(order_signs({-1, +1, -1}), (std::vector<std::uint32_t>{3, 5, 1}));
}

// Each pair of opposites is one of: both positive, + -, - +, both negative, the first missed, the second, both.
TEST(MatchOrder, IsRightForEveryPatternOfSignsAndMisses) {
  for (const std::size_t count : {6u, 8u, 10u, 12u}) {
    const std::size_t half = count / 2;
    const std::size_t states = 7;
    std::size_t patterns = 1, with_matches = 0;
    for (std::size_t i = 0; i < half; ++i) patterns *= states;
    for (std::size_t pattern = 0; pattern < patterns; ++pattern) {
      std::vector<double> radii(count);
      std::vector<std::uint8_t> hits(count, 1);
      std::size_t rest = pattern;
      for (std::size_t i = 0; i < half; ++i, rest /= states) {
        const std::size_t state = rest % states;
        radii[i] = state == 2 || state == 3 ? -0.5 : 0.5;
        radii[i + half] = state == 1 || state == 3 || state >= 4 ? -0.25 : 0.25;
        if (state == 4 || state == 6) hits[i] = 0;
        if (state == 5 || state == 6) hits[i + half] = 0;
      }
      const std::vector<std::uint32_t> wanted = order_by_turning(radii, hits);
      ASSERT_EQ(order(radii, hits), wanted) << count << " vertices, pattern " << pattern;
      with_matches += wanted.empty() ? 0 : 1;
    }
    EXPECT_GT(with_matches, patterns / 2);
  }
}

}  // namespace
}  // namespace fascicle::muscle
