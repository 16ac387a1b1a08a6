#include "tools/fascicle_cook/hull_report.hpp"

#include <cmath>
#include <span>
#include <string>

#include <gmock/gmock.h>

#include "tests/support/shapes.hpp"

namespace fascicle::cook {
namespace {

using testing::HasSubstr;
using testing::Not;

TEST(HullReport, WhatIsNoSolidHasNoHull) {
  const auto measured = measure_hull("soleus", test::inside_out(test::make_sphere(0.1f, 6, 8)), {.vertices = 20});
  ASSERT_FALSE(measured.ok());
  EXPECT_THAT(measured.diagnostics().errors.at(0).cause, HasSubstr("soleus: the mesh encloses -"));
}

TEST(HullReport, MeasuresWhatIsKnown) {
  const TriangleMesh sphere = test::make_sphere(0.1f, 20, 30);
  const auto measured = measure_hull("ball", sphere, {.vertices = 60});
  ASSERT_TRUE(measured.ok()) << to_text(measured.diagnostics());
  EXPECT_TRUE(measured->sound());
  EXPECT_TRUE(measured->closed);
  EXPECT_EQ(measured->fine, &sphere);
  EXPECT_EQ(measured->crossings, 0u);
  EXPECT_EQ(measured->fine_crossings, 0u);
  EXPECT_NEAR(measured->size, 0.1 * 2.0 * std::sqrt(3.0), 0.002);
  EXPECT_GT(measured->furthest, measured->mean);
  EXPECT_GT(measured->mean, 0.0);
  EXPECT_LT(measured->furthest, 0.03);
  const std::string table = to_table(std::span(&*measured, 1));
  EXPECT_THAT(table, HasSubstr("ball          60       116"));
  EXPECT_THAT(table, Not(HasSubstr("NOT")));
}

TEST(HullReport, FewerThanReachableAreWarnedOf) {
  const auto measured = measure_hull("corner", test::make_corner(0.1f), {.vertices = 3});
  ASSERT_TRUE(measured.ok());
  EXPECT_THAT(measured.diagnostics().warnings.at(0).cause, HasSubstr("corner: the hull needs 4 vertices"));
  EXPECT_TRUE(measured->sound());
}

TEST(HullReport, SaysWhatIsWrongWithAHull) {
  const TriangleMesh fine = test::make_sphere(0.1f, 8, 12);
  MeasuredHull bad;
  bad.muscle = "soleus";
  bad.fine = &fine;
  bad.hull.mesh = test::make_corner(0.1f);
  bad.hull.volume = bad.hull.fine_volume = 1.0;
  bad.size = 0.3;
  bad.closed = true;
  EXPECT_TRUE(bad.sound());
  bad.outside = 4.0e-7;
  EXPECT_FALSE(bad.sound());
  EXPECT_THAT(to_table(std::span(&bad, 1)), HasSubstr("NOT ENCLOSING"));
  bad.outside = 2.0e-7;
  EXPECT_TRUE(bad.sound());
  bad.closed = false;
  EXPECT_FALSE(bad.sound());
  EXPECT_THAT(to_table(std::span(&bad, 1)), HasSubstr("NOT CLOSED"));
  bad.crossings = 3;
  EXPECT_THAT(to_table(std::span(&bad, 1)), HasSubstr("3 pairs of triangles pass through each other"));
}

TEST(HullReport, ObjHasTheTriangles) {
  MeasuredHull one;
  one.muscle = "corner";
  one.hull.mesh = test::make_corner(0.1f);
  EXPECT_EQ(to_obj(one), "# corner: coarse hull, m\nv 0 0 0\nv 0.1 0 0\nv 0 0.1 0\nv 0 0 0.1\n"
                         "f 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n");
}

}  // namespace
}  // namespace fascicle::cook
