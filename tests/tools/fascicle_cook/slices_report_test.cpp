#include "tools/fascicle_cook/slices_report.hpp"

#include <sstream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <pugixml.hpp>

#include "tests/support/shapes.hpp"
#include "tools/fascicle_cook/slices_plot.hpp"

namespace fascicle::cook {
namespace {

using testing::HasSubstr;

// A box with a slice of 10 mm x 20 mm, a torus with a ring and a hole, and a plane that misses.
std::vector<MeshSlice> make_slices() {
  TriangleMesh box = test::make_box({0, 0, -1}, {0.01f, 0.02f, 1}), torus = test::make_torus(0.02f, 0.005f, 90, 40);
  box.name = "box, \"old\" <1>";
  torus.name = "torus";
  const SliceStation flat{0.5, {}}, high{0.75, {{0, 0, 9}, {1, 0, 0}, {0, 1, 0}}};
  std::vector<MeshSlice> slices = slice_at(box, std::vector{flat});
  for (MeshSlice& slice : slice_at(torus, std::vector{flat, high})) slices.push_back(std::move(slice));
  return slices;
}

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

TEST(SlicesCsv, OfNothingIsItsHead) {
  const auto lines = lines_of(slices_csv({}));
  ASSERT_EQ(lines.size(), 1u);
  EXPECT_EQ(lines[0],
            "mesh,fraction,loop,closed,area_mm2,perimeter_mm,quotient,normalised_perimeter,dent,convex,"
            "centroid_inside");
}

TEST(SlicesCsv, ALineALoop) {
  const auto lines = lines_of(slices_csv(make_slices()));
  ASSERT_EQ(lines.size(), 5u);
  EXPECT_EQ(lines[1], "\"box, \"\"old\"\" <1>\",0.5,0,1,200,60,0.698132,4.24264,0,1,1");
  EXPECT_THAT(lines[2], HasSubstr("torus,0.5,0,1,19"));  // pi 25^2 = 1963
  EXPECT_THAT(lines[3], HasSubstr("torus,0.5,1,1,-70"));  // the hole: pi 15^2 = 707
  EXPECT_EQ(lines[4], "torus,0.75,,,,,,,,,");
}

TEST(SlicesTable, SaysWhatIsToBeSaid) {
  const auto lines = lines_of(slices_table(make_slices()));
  ASSERT_EQ(lines.size(), 4u);
  EXPECT_THAT(lines[1], HasSubstr("200.0          60.0  0.698  convex"));
  EXPECT_THAT(lines[2], HasSubstr("the largest of 2 loops"));
  EXPECT_THAT(lines[3], HasSubstr("the plane misses the mesh"));
}

TEST(DescribeSlices, CountsAndShares) {
  const std::string text = describe_slices(summarise_slices(make_slices()), 2);
  EXPECT_THAT(text, HasSubstr("2 slices of 2 meshes; 1 more plane missed"));
  EXPECT_THAT(text, HasSubstr("quotient above 0.5      100 %"));
  EXPECT_THAT(text, HasSubstr("in several loops        50 %"));
  EXPECT_EQ(describe_slices({}, 1), "0 slices of 1 mesh\n");
}

int count_points_of(const pugi::xml_document& document, double radius) {
  int count = 0;
  for (const pugi::xml_node circle : document.child("svg").children("circle")) {
    count += circle.attribute("r").as_double() == radius ? 1 : 0;
  }
  return count;
}

TEST(PlotSlices, IsXmlWithAPointASliceAndALegend) {
  pugi::xml_document document;
  const std::string svg = plot_slices("Slices of <a> & b", make_slices());
  ASSERT_TRUE(document.load_string(svg.c_str()));
  EXPECT_EQ(count_points_of(document, 5.0), 2 + 3);
  EXPECT_STREQ(document.child("svg").child("text").text().get(), "Slices of <a> & b");
  // The curve, and an outline a slice.
  int paths = 0;
  for ([[maybe_unused]] const pugi::xml_node path : document.child("svg").children("path")) ++paths;
  EXPECT_EQ(paths, 3);
  EXPECT_THAT(svg, testing::Not(HasSubstr("nan")));
  EXPECT_THAT(svg, testing::Not(HasSubstr("inf")));
}

TEST(PlotSlices, OfNothingIsAnEmptyPlot) {
  pugi::xml_document document;
  ASSERT_TRUE(document.load_string(plot_slices("", {}).c_str()));
  EXPECT_EQ(count_points_of(document, 5.0), 3);
}

TEST(PlotSlices, EverythingLiesInThePicture) {
  // A slice as flat as a band: its outline and its point are still on the page.
  const TriangleMesh band = test::make_box({0, 0, -1}, {1.0f, 0.004f, 1});
  const std::vector<MeshSlice> slices = slice_at(band, std::vector{SliceStation{0.5, {}}});
  pugi::xml_document document;
  ASSERT_TRUE(document.load_string(plot_slices("band", slices).c_str()));
  const double width = document.child("svg").attribute("width").as_double();
  for (const pugi::xml_node circle : document.child("svg").children("circle")) {
    EXPECT_GE(circle.attribute("cx").as_double(), 0.0);
    EXPECT_LE(circle.attribute("cx").as_double(), width);
  }
  int labels = 0;
  for ([[maybe_unused]] const pugi::xml_node text : document.child("svg").children("text")) ++labels;
  EXPECT_LT(labels, 50);
}

}  // namespace
}  // namespace fascicle::cook
