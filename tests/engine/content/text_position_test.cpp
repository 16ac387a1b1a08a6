#include "engine/content/text_position.hpp"

#include <gtest/gtest.h>

#include <string_view>

namespace fascicle {
namespace {

struct Case {
  std::string_view text;
  std::size_t offset;
  int line, column;
};

TEST(LineTable, FindsLineAndColumn) {
  using namespace std::literals;
  const Case cases[] = {
      {"", 0, 1, 1},      {"abc", 2, 1, 3},    {"a\nbc", 2, 2, 1}, {"a\nbc", 1, 1, 2}, {"a\r\nbc", 3, 2, 1},
      {"a\rbc", 2, 2, 1}, {"a\n\nb", 3, 3, 1}, {"a\n", 2, 2, 1},   {"abc", 99, 1, 4},  {"\xc3\xa4\xc3\xb6x", 4, 1, 3},
      {"a\r", 2, 2, 1},
  };
  for (const Case& c : cases) {
    const TextPosition at = LineTable(c.text).position(c.text, c.offset);
    EXPECT_EQ(at.line, c.line) << c.text << " at " << c.offset;
    EXPECT_EQ(at.column, c.column) << c.text << " at " << c.offset;
  }
}

TEST(LineTable, EmptyTableKnowsNothing) { EXPECT_EQ(LineTable().position("abc", 1).line, 0); }

}  // namespace
}  // namespace fascicle
