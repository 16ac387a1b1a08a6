#include "engine/loop/quoted_csv.hpp"

#include <gtest/gtest.h>

namespace fascicle {
namespace {

TEST(QuotedCsv, Table) {
  EXPECT_EQ(quoted_csv(""), "");
  EXPECT_EQ(quoted_csv("plain text"), "plain text");
  EXPECT_EQ(quoted_csv("a,b"), "\"a,b\"");
  EXPECT_EQ(quoted_csv("say \"hi\""), "\"say \"\"hi\"\"\"");
  EXPECT_EQ(quoted_csv("two\nlines"), "\"two\nlines\"");
}

}  // namespace
}  // namespace fascicle
