#include "engine/ecs/view.hpp"

#include <gtest/gtest.h>

#include <optional>
#include <tuple>
#include <type_traits>
#include <vector>

#include "engine/ecs/world.hpp"

namespace fascicle::ecs {
namespace {

struct A {
  int value = 0;
};
struct B {
  int value = 0;
};
struct Never {};

// Entities 0 .. 9; all have A, the multiples of 3 have B, added from the highest down.
struct Fixture {
  Fixture() {
    for (int i = 0; i < 10; ++i) {
      entities.push_back(world.create());
      world.add<A>(entities.back(), {i});
    }
    for (int i = 9; i >= 0; i -= 3) world.add<B>(entities[static_cast<std::size_t>(i)], {100 * i});
  }
  World world;
  std::vector<Entity> entities;
};

TEST(View, OfAComponentNobodyEverHadIsEmpty) {
  Fixture f;
  const View<const A, const Never> view = f.world.view<const A, const Never>();
  EXPECT_EQ(view.candidates(), 0u);
  EXPECT_EQ(view.size_hint(), 0u);
  EXPECT_FALSE(view.contains(f.entities[0]));
  EXPECT_EQ(view.try_get<Never>(f.entities[0]), nullptr);
  EXPECT_NE(view.try_get<A>(f.entities[0]), nullptr);
  view.each([](const A&, const Never&) { ADD_FAILURE(); });
}

TEST(View, StaleEntityIsNotContained) {
  Fixture f;
  const Entity old = f.entities[3];
  f.world.destroy(old);
  const View<A, B> view = f.world.view<A, B>();
  EXPECT_FALSE(view.contains(old));
  EXPECT_FALSE(view.contains(kNoEntity));
  EXPECT_EQ(view.try_get<A>(old), nullptr);
}

TEST(View, SmallestPoolDrivesInItsOrder) {
  Fixture f;
  std::vector<int> seen;
  f.world.view<const A, const B>().each([&](const A& a, const B& b) {
    EXPECT_EQ(b.value, 100 * a.value);
    seen.push_back(a.value);
  });
  EXPECT_EQ(seen, (std::vector<int>{9, 6, 3, 0}));
  EXPECT_EQ((f.world.view<const A, const B>().candidates()), 4u);
}

TEST(View, FirstNamedDrivesAmongEquals) {
  World world;
  const Entity a = world.create();
  const Entity b = world.create();
  world.add<A>(a);
  world.add<A>(b);
  world.add<B>(b);
  world.add<B>(a);
  EXPECT_EQ((world.view<A, B>().entity_at(0)), a);
  EXPECT_EQ((world.view<B, A>().entity_at(0)), b);
}

TEST(View, EachPassesTheEntityWhenAsked) {
  Fixture f;
  std::size_t count = 0;
  f.world.view<const A>().each([&](Entity entity, const A& a) {
    EXPECT_EQ(entity, f.entities[static_cast<std::size_t>(a.value)]);
    ++count;
  });
  EXPECT_EQ(count, 10u);
}

TEST(View, WritesReachTheWorld) {
  Fixture f;
  f.world.view<A, const B>().each([](A& a, const B& b) { a.value = b.value + 1; });
  EXPECT_EQ(f.world.get<A>(f.entities[6]).value, 601);
  EXPECT_EQ(f.world.get<A>(f.entities[5]).value, 5);
}

TEST(View, ConstnessIsAsDeclared) {
  using Mixed = View<const A, B>;
  static_assert(std::is_same_v<decltype(std::declval<Mixed>().get<A>(Entity{})), const A&>);
  static_assert(std::is_same_v<decltype(std::declval<Mixed>().get<const A>(Entity{})), const A&>);
  static_assert(std::is_same_v<decltype(std::declval<Mixed>().try_get<B>(Entity{})), B*>);
  static_assert(std::is_same_v<decltype(std::declval<Mixed>().row(0)), std::optional<std::tuple<const A&, B&>>>);
  Fixture f;
  const Mixed view = f.world.view<const A, B>();
  view.get<B>(f.entities[3]).value = 5;
  EXPECT_EQ(f.world.get<B>(f.entities[3]).value, 5);
  EXPECT_EQ(view.get<A>(f.entities[3]).value, 3);
}

TEST(View, RowsAreTheCandidatesThatHaveAll) {
  World world;
  std::vector<Entity> entities;
  for (int i = 0; i < 4; ++i) {
    entities.push_back(world.create());
    if (i != 1) world.add<A>(entities.back(), {i});
    if (i != 2) world.add<B>(entities.back(), {10 * i});
  }
  const View<A, const B> view = world.view<A, const B>();
  ASSERT_EQ(view.candidates(), 3u);
  std::vector<int> seen;
  for (std::size_t i = 0; i < view.candidates(); ++i) {
    if (const auto row = view.row(i)) {
      const auto& [a, b] = *row;
      a.value += 1000;
      seen.push_back(b.value);
      EXPECT_TRUE(view.contains(view.entity_at(i)));
    } else {
      EXPECT_EQ(view.entity_at(i), entities[2]);
    }
  }
  EXPECT_EQ(seen, (std::vector<int>{0, 30}));
  EXPECT_EQ(world.get<A>(entities[3]).value, 1003);
  EXPECT_EQ(world.get<A>(entities[2]).value, 2);
}

}  // namespace
}  // namespace fascicle::ecs
