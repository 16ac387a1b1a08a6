#include "engine/ecs/world.hpp"

#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace fascicle::ecs {
namespace {

struct Position {
  float x = 0;
};
struct Name {
  std::string text;
};
std::size_t heap_bytes(const Name& name) { return name.text.size(); }
struct Tag {};

TEST(World, NoEntityIsNeverAlive) {
  World world;
  EXPECT_FALSE(world.alive(kNoEntity));
  EXPECT_FALSE(world.alive({0, 0}));
  EXPECT_FALSE(world.destroy(kNoEntity));
  EXPECT_FALSE(world.destroy({3, 0}));
  EXPECT_FALSE(world.has<Position>(kNoEntity));
  EXPECT_EQ(world.try_get<Position>(kNoEntity), nullptr);
  EXPECT_FALSE(world.remove<Position>(kNoEntity));
}

TEST(World, StaleEntityHasNothing) {
  World world;
  const Entity old = world.create();
  world.add<Position>(old, {1});
  EXPECT_TRUE(world.destroy(old));
  EXPECT_FALSE(world.alive(old));
  EXPECT_FALSE(world.has<Position>(old));
  EXPECT_EQ(world.try_get<Position>(old), nullptr);

  const Entity fresh = world.create();
  world.add<Position>(fresh, {2});
  EXPECT_EQ(fresh.index, old.index);
  EXPECT_NE(fresh.generation, old.generation);
  EXPECT_FALSE(world.alive(old));
  EXPECT_EQ(world.try_get<Position>(old), nullptr);
  EXPECT_FALSE(world.remove<Position>(old));
  EXPECT_EQ(world.get<Position>(fresh).x, 2);
}

TEST(World, SecondDestroyDoesNothing) {
  World world;
  const Entity a = world.create();
  EXPECT_TRUE(world.destroy(a));
  EXPECT_FALSE(world.destroy(a));
  const Entity b = world.create();
  const Entity c = world.create();
  EXPECT_NE(b.index, c.index);  // the index was not freed twice
  EXPECT_FALSE(world.destroy(a));
  EXPECT_TRUE(world.alive(b));
  EXPECT_EQ(world.entity_count(), 2u);
}

TEST(World, GenerationsGrowWithEveryReuse) {
  World world;
  Entity last = world.create();
  for (int i = 0; i < 1000; ++i) {
    world.destroy(last);
    const Entity next = world.create();
    EXPECT_EQ(next.index, last.index);
    EXPECT_EQ(next.generation, last.generation + 1);
    last = next;
  }
  EXPECT_EQ(world.entity_count(), 1u);
}

TEST(World, DestroyTakesAllComponents) {
  World world;
  const Entity a = world.create();
  const Entity b = world.create();
  world.add<Position>(a);
  world.add<Name>(a, {"a"});
  world.add<Name>(b, {"b"});
  world.destroy(a);
  EXPECT_FALSE(world.has<Position>(a));
  EXPECT_FALSE(world.has<Name>(a));
  EXPECT_EQ(world.get<Name>(b).text, "b");
  EXPECT_EQ(world.view<Position>().candidates(), 0u);
}

TEST(World, AddReplacesAndRemoveForgets) {
  World world;
  const Entity a = world.create();
  EXPECT_EQ(world.add<Position>(a, {1}).x, 1);
  EXPECT_EQ(world.add<Position>(a, {2}).x, 2);
  EXPECT_TRUE(world.remove<Position>(a));
  EXPECT_FALSE(world.remove<Position>(a));
  EXPECT_FALSE(world.has<Position>(a));
  world.add<Tag>(a);
  EXPECT_TRUE(world.has<Tag>(a));
}

TEST(World, ConstWorldGivesConstComponents) {
  World world;
  const Entity a = world.create();
  world.add<Position>(a, {1});
  world.set_resource<int>(3);
  const World& constant = world;
  static_assert(std::is_same_v<decltype(constant.get<Position>(a)), const Position&>);
  static_assert(std::is_same_v<decltype(constant.try_get<Position>(a)), const Position*>);
  static_assert(std::is_same_v<decltype(constant.resource<int>()), const int&>);
  static_assert(std::is_same_v<decltype(world.get<const Position>(a)), const Position&>);
  EXPECT_EQ(constant.get<Position>(a).x, 1);
  EXPECT_EQ(constant.resource<int>(), 3);
  EXPECT_EQ(constant.view<const Position>().candidates(), 1u);
}

TEST(World, ResourceIsAbsentUntilSet) {
  World world;
  EXPECT_EQ(world.try_resource<int>(), nullptr);
  EXPECT_EQ(world.set_resource<int>(3), 3);
  EXPECT_EQ(*world.try_resource<int>(), 3);
}

TEST(World, SettingAResourceAgainKeepsItsAddress) {
  World world;
  std::unique_ptr<int>* first = &world.set_resource(std::make_unique<int>(1));
  for (int i = 0; i < 10; ++i) world.set_resource(std::vector<int>(1));  // others come in between
  EXPECT_EQ(&world.set_resource(std::make_unique<int>(2)), first);
  EXPECT_EQ(*world.resource<std::unique_ptr<int>>(), 2);
}

TEST(World, MemoryIsListedByName) {
  World world;
  const Entity a = world.create();
  world.add<Position>(a);
  world.add<Name>(a, {std::string(100, 'x')});
  const Entity b = world.create();
  world.add<Name>(b, {std::string(50, 'x')});
  const std::vector<ComponentMemory> memory = world.memory_by_component();
  ASSERT_EQ(memory.size(), 2u);
  EXPECT_EQ(memory[0].name, "Name");
  EXPECT_EQ(memory[0].count, 2u);
  EXPECT_GE(memory[0].bytes, 150 + 2 * sizeof(Name));
  EXPECT_EQ(memory[1].name, "Position");
  EXPECT_EQ(memory[1].count, 1u);
}

#ifndef NDEBUG
TEST(WorldDeathTest, ProgrammerErrorsAssert) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  World world;
  const Entity a = world.create();
  EXPECT_DEATH(world.get<Position>(a), "lacks this component");
  EXPECT_DEATH(world.resource<int>(), "no such resource");
  world.destroy(a);
  EXPECT_DEATH(world.add<Position>(a), "not alive");
  world.lock_structure(true);
  EXPECT_DEATH(world.create(), "only at barriers");
}
#endif

}  // namespace
}  // namespace fascicle::ecs
