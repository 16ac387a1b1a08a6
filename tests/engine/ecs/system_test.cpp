#include "engine/ecs/system.hpp"

#include <gtest/gtest.h>

#include <functional>
#include <memory>
#include <string>

namespace fascicle::ecs {
namespace {

struct A {
  int value = 0;
};
struct B {
  int value = 0;
};
struct Clock {
  int tick = 0;
};

void free_function(View<const A, B> view, Resource<const Clock> clock) {
  view.each([&](const A& a, B& b) { b.value = a.value + clock->tick; });
}
void takes_nothing() noexcept {}
void takes_references(const View<A>& view, const Resource<Clock>&, Commands&) { (void)view; }

struct Functor {
  void operator()(View<A>) const {}
};
struct MutableFunctor {
  void operator()(View<const A>, Resource<Clock>) { ++calls; }
  int calls = 0;
};

template <class F>
std::string access_of(F) {
  return to_text(SystemOf<F>::access());
}

TEST(System, AccessComesFromTheSignature) {
  EXPECT_EQ(access_of(takes_nothing), "nothing");
  EXPECT_EQ(access_of(free_function), "reads A, Clock; writes B");
  EXPECT_EQ(access_of(takes_references), "writes A, Clock; commands");
  EXPECT_EQ(access_of(Functor{}), "writes A");
  EXPECT_EQ(access_of(MutableFunctor{}), "reads A; writes Clock");
  EXPECT_EQ(access_of([](View<const A>, View<A>) {}), "writes A");
  EXPECT_EQ(access_of([n = 0](Commands&) mutable { ++n; }), "commands");
  EXPECT_EQ(access_of(std::function<void(View<const B>)>([](View<const B>) {})), "reads B");
}

TEST(System, ArgumentsComeFromTheWorld) {
  World world;
  world.set_resource(Clock{5});
  const Entity entity = world.create();
  world.add<A>(entity, {10});
  world.add<B>(entity);
  Commands commands;
  SystemContext context{world, commands, "test"};
  SystemOf<void (*)(View<const A, B>, Resource<const Clock>)>(free_function).run(context);
  EXPECT_EQ(world.get<B>(entity).value, 15);
}

TEST(System, MissingResourceIsNamed) {
  World world;
  Commands commands;
  SystemContext context{world, commands, "tick_clock"};
  const auto system = [](Resource<Clock>) { FAIL(); };
  try {
    SystemOf<decltype(system)>(system).run(context);
    FAIL();
  } catch (const std::logic_error& error) {
    EXPECT_NE(std::string(error.what()).find("tick_clock"), std::string::npos);
    EXPECT_NE(std::string(error.what()).find("Clock"), std::string::npos);
    EXPECT_NE(std::string(error.what()).find("set_resource"), std::string::npos);
  }
}

TEST(System, MayHoldMoveOnlyState) {
  World world;
  Commands commands;
  SystemContext context{world, commands, "test"};
  auto system = [count = std::make_unique<int>(0)](Commands&) { ++*count; };
  SystemOf<decltype(system)> stored(std::move(system));
  stored.run(context);
}

}  // namespace
}  // namespace fascicle::ecs
