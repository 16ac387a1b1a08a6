#include "tools/fascicle_cook/svg_plot.hpp"

#include <cmath>
#include <limits>

#include <gmock/gmock.h>
#include <pugixml.hpp>

namespace fascicle::cook {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

int count(const pugi::xml_document& document, const char* element) {
  int found = 0;
  for ([[maybe_unused]] const pugi::xml_node node : document.child("svg").children(element)) ++found;
  return found;
}

pugi::xml_document parse(const std::string& svg) {
  pugi::xml_document document;
  EXPECT_TRUE(document.load_string(svg.c_str())) << svg;
  EXPECT_EQ(svg.find("nan"), std::string::npos);
  EXPECT_EQ(svg.find("inf"), std::string::npos);
  return document;
}

TEST(TickStep, IsARoundNumberAndNotTooMany) {
  EXPECT_NEAR(tick_step(300.0, 12.0), 50.0, 1e-9);
  EXPECT_NEAR(tick_step(1.0, 7.0), 0.2, 1e-12);
  EXPECT_NEAR(tick_step(0.01, 7.0), 0.002, 1e-12);
}

TEST(DrawCharts, OfNothingIsAPictureAllTheSame) {
  EXPECT_EQ(count(parse(draw_charts("", "", {})), "path"), 0);
  const std::vector<Chart> empty(2);
  EXPECT_EQ(count(parse(draw_charts("", "", empty)), "path"), 0);
}

TEST(DrawCharts, ALineAPathAndABandBehindThem) {
  std::vector<Chart> charts(2);
  charts[0].y_label = "a < b & c";
  charts[0].lines = {{"one", "#123456", 1.8, {1.0, 2.0, 3.0}}, {"", "#654321", 1.8, {2.0, 2.0, 2.0}}};
  charts[0].band = ChartBand{"between", "#abcdef", {0.5, 1.0, 1.5}, {4.0, 5.0, 6.0}};
  charts[1].lines = {{"three", "#111111", 1.8, {7.0, 7.0, 7.0}}};
  const auto document = parse(draw_charts("Title <1> & 2", "below", charts));
  EXPECT_EQ(count(document, "path"), 4);
  EXPECT_STREQ(document.child("svg").child("text").text().get(), "Title <1> & 2");
  const auto legend = [&](const char* words) {
    for (const pugi::xml_node text : document.child("svg").children("text")) {
      if (std::string(text.text().get()) == words) return true;
    }
    return false;
  };
  EXPECT_TRUE(legend("one") && legend("between") && legend("three") && legend("a < b & c"));
}

TEST(DrawCharts, WhatIsNotFiniteLeavesAGap) {
  std::vector<Chart> charts(1);
  charts[0].lines = {{"", "#123456", 1.8, {kNaN, 1.0, 2.0, kNaN, 3.0, 1.0, std::numeric_limits<double>::infinity()}}};
  EXPECT_EQ(count(parse(draw_charts("", "", charts)), "path"), 2);
}

TEST(DrawCharts, PointsStandWhereTheirValuesAre) {
  std::vector<Chart> charts(1);
  charts[0].lines = {{"", "#123456", 1.8, std::vector<double>(100, 1.0)}};
  charts[0].lines[0].values[49] = 2.0;
  const auto document = parse(draw_charts("", "", charts));
  const std::string path = document.child("svg").child("path").attribute("d").value();
  // The panel starts at x = 110 and is 820 wide for 100 steps; the peak is the highest point (y down).
  double x = 0.0, y = 0.0, peak_x = 0.0, peak_y = 1e9;
  for (std::size_t i = 0; i < path.size(); ++i) {
    if (path[i] != 'M' && path[i] != 'L') continue;
    ASSERT_EQ(std::sscanf(path.c_str() + i + 1, "%lf %lf", &x, &y), 2);
    if (y >= peak_y) continue;
    peak_x = x;
    peak_y = y;
  }
  EXPECT_NEAR(peak_x, 110.0 + 820.0 * 50.0 / 100.0, 0.1);
  EXPECT_GT(y, peak_y + 200.0);
  EXPECT_NEAR(x, 930.0, 0.1);
}

// Powers of ten are equally far from each other; what has no logarithm leaves a gap.
TEST(DrawCharts, ALogarithmicAxis) {
  std::vector<Chart> charts(1);
  charts[0].logarithmic = true;
  charts[0].lines = {{"", "#123456", 1.8, {1e-1, 1e-2, 1e-3, 0.0, 1e-2, 1e-4, -1.0}}};
  const std::string svg = draw_charts("", "", charts, "iteration");
  const auto document = parse(svg);
  EXPECT_EQ(count(document, "path"), 2);
  double x[3], y[3];
  const std::string path = document.child("svg").child("path").attribute("d").value();
  ASSERT_EQ(std::sscanf(path.c_str(), "M%lf %lfL%lf %lfL%lf %lf", &x[0], &y[0], &x[1], &y[1], &x[2], &y[2]), 6) << path;
  EXPECT_NEAR(y[1] - y[0], y[2] - y[1], 0.11);
  EXPECT_GT(y[1], y[0] + 40.0);
  for (const char* label : {">1e-1<", ">1e-4<", ">iteration<"}) EXPECT_NE(svg.find(label), std::string::npos) << label;
  EXPECT_EQ(svg.find(">step<"), std::string::npos);
  // Nothing to show.
  charts[0].lines[0].values = {0.0, -1.0};
  EXPECT_EQ(count(parse(draw_charts("", "", charts)), "path"), 0);
}

}  // namespace
}  // namespace fascicle::cook
