#include "game/report.hpp"

#include <cmath>
#include <limits>

#include <gmock/gmock.h>
#include <json/json.h>

namespace fascicle::game {
namespace {

Json::Value parsed(const std::string& text) {
  Json::Value root;
  Json::Reader reader;
  EXPECT_TRUE(reader.parse(text, root)) << text;
  return root;
}

TEST(Report, HoldsAValueAFrameAndNullWhereNoneWasRecorded) {
  Report report;
  report.begin_frame();
  report.record("a", 1.5);
  report.begin_frame();
  report.record("late", -2.0);
  report.begin_frame();
  report.record("a", std::numeric_limits<double>::infinity());
  const Json::Value root = parsed(report.to_json("walker", 0xabcdu));
  EXPECT_EQ(root["scene"].asString(), "walker");
  EXPECT_EQ(root["frames"].asInt(), 3);
  EXPECT_EQ(root["hash"].asString(), "000000000000abcd");
  const Json::Value& a = root["metrics"]["a"];
  ASSERT_EQ(a.size(), 3u);
  EXPECT_EQ(a[0].asDouble(), 1.5);
  EXPECT_TRUE(a[1].isNull());
  EXPECT_TRUE(a[2].isNull()) << "not finite";
  const Json::Value& late = root["metrics"]["late"];
  ASSERT_EQ(late.size(), 3u);
  EXPECT_TRUE(late[0].isNull());
  EXPECT_EQ(late[1].asDouble(), -2.0);
}

TEST(Report, LastValueOfAFrameWins) {
  Report report;
  report.begin_frame();
  report.record("a", 1.0);
  report.record("a", 2.0);
  EXPECT_EQ(parsed(report.to_json("s", 0))["metrics"]["a"][0].asDouble(), 2.0);
}

TEST(Report, EscapesNames) {
  Report report;
  report.begin_frame();
  report.record("quote\" slash\\ line\n", 1.0);
  EXPECT_TRUE(parsed(report.to_json("\"scene\"", 0))["metrics"].isMember("quote\" slash\\ line\n"));
}

TEST(Report, KeepsSixteenDigits) {
  Report report;
  report.begin_frame();
  report.record("a", 0.1234567890123456);
  EXPECT_EQ(parsed(report.to_json("s", 0))["metrics"]["a"][0].asDouble(), 0.1234567890123456);
}

}  // namespace
}  // namespace fascicle::game
