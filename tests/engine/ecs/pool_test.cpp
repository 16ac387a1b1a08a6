#include "engine/ecs/pool.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <map>
#include <memory>
#include <random>
#include <vector>

namespace fascicle::ecs {
namespace {

struct Owned {
  std::vector<char> data;
};
std::size_t heap_bytes(const Owned& owned) { return owned.data.size(); }

std::vector<std::uint32_t> indices(const PoolBase& pool) {
  std::vector<std::uint32_t> result;
  for (const Entity entity : pool.entities()) result.push_back(entity.index);
  return result;
}

TEST(Pool, EmptyHasNothing) {
  Pool<int> pool;
  EXPECT_EQ(pool.size(), 0u);
  EXPECT_FALSE(pool.contains({0, 0}));
  EXPECT_FALSE(pool.contains(kNoEntity));
  EXPECT_EQ(pool.find({5, 0}), nullptr);
  EXPECT_FALSE(pool.remove({0, 0}));
  EXPECT_FALSE(pool.remove(kNoEntity));
}

TEST(Pool, OtherGenerationIsAbsent) {
  Pool<int> pool;
  pool.add({3, 1}, 7);
  EXPECT_TRUE(pool.contains({3, 1}));
  EXPECT_FALSE(pool.contains({3, 0}));
  EXPECT_FALSE(pool.contains({3, 2}));
  EXPECT_FALSE(pool.remove({3, 0}));
  EXPECT_EQ(pool.size(), 1u);
}

TEST(Pool, AddAgainReplaces) {
  Pool<int> pool;
  pool.add({3, 0}, 7);
  EXPECT_EQ(pool.add({3, 0}, 8), 8);
  EXPECT_EQ(pool.size(), 1u);
  EXPECT_EQ(*pool.find({3, 0}), 8);
}

TEST(Pool, RemovalMovesTheLastIntoTheGap) {
  Pool<int> pool;
  for (std::uint32_t i = 0; i < 5; ++i) pool.add({i, 0}, static_cast<int>(10 * i));
  EXPECT_TRUE(pool.remove({1, 0}));
  EXPECT_EQ(indices(pool), (std::vector<std::uint32_t>{0, 4, 2, 3}));
  EXPECT_TRUE(pool.remove({3, 0}));  // the last itself
  EXPECT_EQ(indices(pool), (std::vector<std::uint32_t>{0, 4, 2}));
  EXPECT_EQ(*pool.find({4, 0}), 40);
  EXPECT_EQ(pool.values()[1], 40);
}

TEST(Pool, HoldsMoveOnlyValues) {
  Pool<std::unique_ptr<int>> pool;
  pool.add({0, 0}, std::make_unique<int>(1));
  pool.add({1, 0}, std::make_unique<int>(2));
  pool.remove({0, 0});
  EXPECT_EQ(**pool.find({1, 0}), 2);
}

TEST(Pool, CountsWhatComponentsOwn) {
  Pool<Owned> pool;
  pool.add({0, 0}, {std::vector<char>(1000)});
  const std::size_t before = pool.bytes();
  pool.find({0, 0})->data.resize(5000);
  EXPECT_EQ(pool.bytes(), before + 4000);
  EXPECT_GE(before, 1000 + sizeof(Owned) + sizeof(Entity) + sizeof(std::uint32_t));
}

// Any sequence of adds and removes against a map.
TEST(Pool, AgreesWithAMap) {
  std::mt19937 random(1);
  Pool<int> pool;
  std::map<std::uint32_t, int> expected;
  for (int step = 0; step < 20000; ++step) {
    const std::uint32_t index = random() % 200;
    if (random() % 2 == 0) {
      pool.add({index, 0}, step);
      expected[index] = step;
    } else {
      EXPECT_EQ(pool.remove({index, 0}), expected.erase(index) == 1);
    }
    ASSERT_EQ(pool.size(), expected.size());
  }
  for (const auto& [index, value] : expected) {
    ASSERT_NE(pool.find({index, 0}), nullptr);
    EXPECT_EQ(*pool.find({index, 0}), value);
  }
  for (std::size_t i = 0; i < pool.size(); ++i) EXPECT_EQ(pool.position(pool.entities()[i]), i);
}

}  // namespace
}  // namespace fascicle::ecs
