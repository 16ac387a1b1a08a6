#include "engine/math/state_hash.hpp"

#include <set>
#include <vector>

#include <gtest/gtest.h>

namespace fascicle {
namespace {

std::uint64_t hash_of(const std::vector<float>& values) {
  StateHash hash;
  hash.add(std::span<const float>(values));
  return hash.value();
}

TEST(StateHash, EveryBitCounts) {
  std::vector<std::uint8_t> bytes(37, 0);
  std::set<std::uint64_t> seen;
  for (std::size_t bit = 0; bit < 8 * bytes.size(); ++bit) {
    bytes[bit / 8] ^= static_cast<std::uint8_t>(1u << (bit % 8));
    StateHash hash;
    hash.add(std::span<const std::uint8_t>(bytes));
    EXPECT_TRUE(seen.insert(hash.value()).second) << "bit " << bit;
  }
}

TEST(StateHash, OrderCounts) {
  EXPECT_EQ(hash_of({1.0f, 2.0f, 3.0f}), hash_of({1.0f, 2.0f, 3.0f}));
  EXPECT_NE(hash_of({1.0f, 2.0f, 3.0f}), hash_of({3.0f, 2.0f, 1.0f}));
  EXPECT_NE(hash_of({0.0f}), hash_of({-0.0f}));
}

}  // namespace
}  // namespace fascicle
