#include "engine/ecs/type_info.hpp"

#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

namespace outer::inner {
struct Named {};
template <class T, int N>
struct Templated {};
}  // namespace outer::inner

namespace fascicle::ecs {
namespace {

struct Hidden {};

TEST(TypeInfo, NameLeavesOutNamespaces) {
  EXPECT_EQ(type_id<outer::inner::Named>()->name, "Named");
  EXPECT_EQ(type_id<outer::inner::Named>()->full_name, "outer::inner::Named");
  EXPECT_EQ(type_id<Hidden>()->name, "Hidden");
  EXPECT_EQ(type_id<int>()->name, "int");
}

TEST(TypeInfo, NameKeepsTemplateArguments) {
  const std::string name((type_id<outer::inner::Templated<outer::inner::Named, 3>>()->name));
  EXPECT_EQ(name.find("Templated<outer::inner::Named, 3"), 0u) << name;
  EXPECT_EQ(name.back(), '>') << name;
}

TEST(TypeInfo, ConstIsTheSameType) {
  EXPECT_EQ(type_id<const Hidden>(), type_id<Hidden>());
  EXPECT_NE(type_id<outer::inner::Named>(), type_id<Hidden>());
  EXPECT_NE((type_id<outer::inner::Templated<int, 1>>()), (type_id<outer::inner::Templated<int, 2>>()));
}

TEST(TypeTable, FindsNothingWhenEmpty) {
  const TypeTable<int> table;
  EXPECT_EQ(table.find(type_id<int>()), nullptr);
  EXPECT_EQ(table.size(), 0u);
}

template <int... N>
std::vector<TypeId> many_types(std::integer_sequence<int, N...>) {
  return {type_id<outer::inner::Templated<int, N>>()...};
}

TEST(TypeTable, KeepsValuesWhileItGrows) {
  const std::vector<TypeId> types = many_types(std::make_integer_sequence<int, 100>{});
  TypeTable<int> table;
  for (std::size_t i = 0; i < types.size(); ++i) table.insert(types[i], static_cast<int>(i));
  ASSERT_EQ(table.size(), types.size());
  for (std::size_t i = 0; i < types.size(); ++i) {
    ASSERT_NE(table.find(types[i]), nullptr);
    EXPECT_EQ(*table.find(types[i]), static_cast<int>(i));
  }
  EXPECT_EQ(table.find(type_id<Hidden>()), nullptr);
}

// Two types may share name and hash (types of one name in two anonymous namespaces do); their addresses differ.
TEST(TypeTable, TellsTypesOfOneNameApart) {
  const TypeInfo first{"a::Same", "Same", 42};
  const TypeInfo second{"a::Same", "Same", 42};
  TypeTable<int> table;
  table.insert(&first, 1);
  EXPECT_EQ(table.find(&second), nullptr);
  table.insert(&second, 2);
  EXPECT_EQ(*table.find(&first), 1);
  EXPECT_EQ(*table.find(&second), 2);
}

}  // namespace
}  // namespace fascicle::ecs
