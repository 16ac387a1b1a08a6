#include "engine/content/result.hpp"

#include <gtest/gtest.h>

namespace fascicle {
namespace {

TEST(Diagnostic, PrintsAllParts) {
  const Diagnostic diagnostic{"a.json", 3, 14, "/muscles/0", "-1 is out of range", "write a number at least 0"};
  EXPECT_EQ(to_string(diagnostic), "a.json:3:14: /muscles/0: -1 is out of range; write a number at least 0");
}

TEST(Diagnostic, LeavesOutWhatItLacks) {
  EXPECT_EQ(to_string({"a.glb", 0, 0, "/nodes/1", "cause", "remedy"}), "a.glb: /nodes/1: cause; remedy");
  EXPECT_EQ(to_string({"a.glb", 0, 0, "", "cause", ""}), "a.glb: cause");
  EXPECT_EQ(to_string({"a.xml", 7, 0, "", "cause", ""}), "a.xml:7: cause");
  EXPECT_EQ(to_string({"", 0, 0, "", "cause", "remedy"}), "cause; remedy");
  EXPECT_EQ(to_string({"", 0, 0, "", "", ""}), "");
}

TEST(Diagnostics, AppendKeepsTheOrder) {
  Diagnostics all;
  all.errors.push_back({"a", 0, 0, "", "first", ""});
  Diagnostics more;
  more.errors.push_back({"b", 0, 0, "", "second", ""});
  more.warnings.push_back({"b", 0, 0, "", "third", ""});
  all.append(std::move(more));
  EXPECT_EQ(to_text(all), "error: a: first\nerror: b: second\nwarning: b: third\n");
  EXPECT_FALSE(all.ok());
}

TEST(Diagnostics, JsonEscapesEverything) {
  Diagnostics all;
  all.warnings.push_back({"a\\b", 1, 2, "/x", "say \"no\"\n\x01", "tab\t"});
  EXPECT_EQ(to_json(all), R"({"errors":[],"warnings":[{"file":"a\\b","line":1,"column":2,"path":"/x",)"
                          R"("cause":"say \"no\"\n\u0001","remedy":"tab\t"}]})");
}

TEST(Result, HoldsAValueOrErrors) {
  const Result<int> good = 3;
  EXPECT_TRUE(good.ok());
  EXPECT_EQ(*good, 3);
  const Result<int> bad = Diagnostic{"f", 0, 0, "", "broken", ""};
  EXPECT_FALSE(bad.ok());
  EXPECT_EQ(bad.diagnostics().errors.size(), 1u);
}

}  // namespace
}  // namespace fascicle
