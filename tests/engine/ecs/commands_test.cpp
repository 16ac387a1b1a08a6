#include "engine/ecs/commands.hpp"

#include <gtest/gtest.h>

#include <memory>
#include <stdexcept>
#include <vector>

namespace fascicle::ecs {
namespace {

struct Value {
  int number = 0;
};
struct Holder {
  std::unique_ptr<int> owned;
};

std::vector<int> values(World& world) {
  std::vector<int> result;
  world.view<const Value>().each([&](const Value& value) { result.push_back(value.number); });
  return result;
}

TEST(Commands, OnStaleEntitiesDoNothing) {
  World world;
  const Entity stale = world.create();
  world.destroy(stale);
  const Entity reused = world.create();
  Commands commands;
  commands.add<Value>(stale, {1});
  commands.remove<Value>(stale);
  commands.destroy(stale);
  commands.destroy(kNoEntity);
  commands.then(stale, [](World&, Entity) { ADD_FAILURE(); });
  commands.apply(world);
  EXPECT_TRUE(world.alive(reused));
  EXPECT_FALSE(world.has<Value>(reused));
}

TEST(Commands, EntityDestroyedEarlierInTheListIsLeftAlone) {
  World world;
  const Entity entity = world.create();
  Commands commands;
  commands.destroy(entity);
  commands.add<Value>(entity, {1});
  commands.destroy(entity);
  commands.apply(world);
  EXPECT_EQ(world.entity_count(), 0u);
  EXPECT_TRUE(values(world).empty());
}

TEST(Commands, NothingHappensBeforeApply) {
  World world;
  const Entity entity = world.create();
  Commands commands;
  commands.add<Value>(entity, {1});
  EXPECT_EQ(commands.size(), 1u);
  EXPECT_FALSE(world.has<Value>(entity));
  commands.apply(world);
  EXPECT_EQ(world.get<Value>(entity).number, 1);
  EXPECT_TRUE(commands.empty());
  commands.apply(world);  // a second time has nothing to do
}

TEST(Commands, RunInTheOrderAsked) {
  World world;
  const Entity entity = world.create();
  std::vector<int> order;
  Commands commands;
  commands.run([&](World&) { order.push_back(1); });
  commands.add<Value>(entity, {1});
  commands.run([&](World& w) { order.push_back(w.get<Value>(entity).number + 1); });
  commands.remove<Value>(entity);
  commands.run([&](World& w) { order.push_back(w.has<Value>(entity) ? 0 : 3); });
  commands.apply(world);
  EXPECT_EQ(order, (std::vector<int>{1, 2, 3}));
}

TEST(Commands, PlaceholdersStandForTheEntitiesMade) {
  World world;
  Commands commands;
  const Entity first = commands.create();
  const Entity second = commands.create();
  EXPECT_NE(first, second);
  EXPECT_FALSE(world.alive(first));
  commands.add<Value>(second, {2});
  commands.add<Value>(first, {1});
  Entity made;
  commands.then(second, [&](World& w, Entity entity) {
    made = entity;
    EXPECT_EQ(w.get<Value>(entity).number, 2);
  });
  commands.apply(world);
  EXPECT_TRUE(world.alive(made));
  EXPECT_FALSE(world.alive(first));
  EXPECT_EQ(values(world), (std::vector<int>{2, 1}));
}

TEST(Commands, PlaceholderOfAnEarlierBarrierIsStale) {
  World world;
  Commands commands;
  const Entity old = commands.create();
  commands.apply(world);
  const Entity fresh = commands.create();
  EXPECT_NE(old, fresh);
  commands.add<Value>(old, {1});
  commands.add<Value>(fresh, {2});
  commands.apply(world);
  EXPECT_EQ(values(world), (std::vector<int>{2}));
}

TEST(Commands, PlaceholderOfAnotherListIsUnknown) {
  World world;
  Commands mine(1), other(2);
  const Entity foreign = other.create();
  const Entity own = mine.create();
  EXPECT_NE(own, foreign);
  mine.add<Value>(foreign, {1});
  mine.apply(world);
  EXPECT_TRUE(values(world).empty());
}

TEST(Commands, PlaceholderUsedBeforeItsCreationInAnotherFrameIsUnknown) {
  World world;
  Commands commands;
  const Entity pending = commands.create();
  commands.clear();  // the frame failed: its commands are dropped
  commands.add<Value>(pending, {1});
  commands.apply(world);
  EXPECT_EQ(world.entity_count(), 0u);
}

TEST(Commands, CarryMoveOnlyValues) {
  World world;
  Commands commands;
  const Entity entity = commands.create();
  commands.add(entity, Holder{std::make_unique<int>(5)});
  commands.apply(world);
  int found = 0;
  world.view<const Holder>().each([&](const Holder& holder) { found = *holder.owned; });
  EXPECT_EQ(found, 5);
}

TEST(Commands, TheRestIsDroppedWhenOneThrows) {
  World world;
  Commands commands;
  commands.create();
  commands.run([](World&) { throw std::runtime_error("no"); });
  commands.create();
  EXPECT_THROW(commands.apply(world), std::runtime_error);
  EXPECT_TRUE(commands.empty());
  EXPECT_EQ(world.entity_count(), 1u);
  commands.apply(world);
  EXPECT_EQ(world.entity_count(), 1u);
}

}  // namespace
}  // namespace fascicle::ecs
