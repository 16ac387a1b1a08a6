#include "engine/ecs/access.hpp"

#include <gtest/gtest.h>

#include <string>
#include <string_view>
#include <vector>

namespace fascicle::ecs {
namespace {

struct A {};
struct B {};

Access make(std::vector<AccessEntry> entries) {
  Access access;
  for (const AccessEntry& entry : entries) access.declare(entry);
  return access;
}

const AccessEntry kReadA{type_id<A>(), false, false};
const AccessEntry kWriteA{type_id<A>(), false, true};
const AccessEntry kReadB{type_id<B>(), false, false};
const AccessEntry kWriteB{type_id<B>(), false, true};
const AccessEntry kReadResourceA{type_id<A>(), true, false};
const AccessEntry kWriteResourceA{type_id<A>(), true, true};

TEST(Access, ConflictTable) {
  struct Row {
    const char* what;
    std::vector<AccessEntry> earlier, later;
    std::vector<std::string_view> conflicts;
  };
  const Row rows[] = {
      {"nothing", {}, {}, {}},
      {"read, read", {kReadA}, {kReadA}, {}},
      {"read, write", {kReadA}, {kWriteA}, {"A"}},
      {"write, read", {kWriteA}, {kReadA}, {"A"}},
      {"write, write", {kWriteA}, {kWriteA}, {"A"}},
      {"different types", {kWriteA}, {kWriteB}, {}},
      {"both", {kWriteA, kReadB}, {kReadA, kWriteB}, {"A", "B"}},
      {"read twice, written once", {kReadA, kReadB}, {kReadA, kWriteB}, {"B"}},
      {"a component and a resource of one type", {kWriteA}, {kWriteResourceA}, {}},
      {"resource read, read", {kReadResourceA}, {kReadResourceA}, {}},
      {"resource read, write", {kReadResourceA}, {kWriteResourceA}, {"A"}},
      {"read and written by one system counts as written", {kReadA, kWriteA}, {kReadA}, {"A"}},
      {"written and read by one system counts as written", {kWriteA, kReadA}, {kReadA}, {"A"}},
  };
  for (const Row& row : rows) EXPECT_EQ(find_conflicts(make(row.earlier), make(row.later)), row.conflicts) << row.what;
}

TEST(Access, CommandsDoNotConflict) {
  Access a, b;
  a.declare_commands();
  b.declare_commands();
  EXPECT_TRUE(find_conflicts(a, b).empty());
}

TEST(Access, Text) {
  EXPECT_EQ(to_text(Access{}), "nothing");
  EXPECT_EQ(to_text(make({kReadB, kReadA})), "reads A, B");
  EXPECT_EQ(to_text(make({kWriteB, kReadA})), "reads A; writes B");
  Access access = make({kWriteB, kWriteA});
  EXPECT_EQ(to_text(access), "writes A, B");
  access.declare_commands();
  EXPECT_EQ(to_text(access), "writes A, B; commands");
  Access only;
  only.declare_commands();
  EXPECT_EQ(to_text(only), "commands");
}

}  // namespace
}  // namespace fascicle::ecs
