#include "engine/geometry/closest_point.hpp"

#include <cmath>
#include <limits>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "tests/support/shapes.hpp"

namespace fascicle {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

double exact_distance(const TriangleMesh& mesh, const glm::dvec3& p) {
  double nearest = std::numeric_limits<double>::max();
  for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
    nearest = std::min(nearest, glm::distance(p, closest_point_on_triangle(p, mesh.positions[mesh.indices[i]],
                                                                           mesh.positions[mesh.indices[i + 1]],
                                                                           mesh.positions[mesh.indices[i + 2]])));
  }
  return nearest;
}

TEST(ClosestPoints, NothingIsNowhere) {
  const ClosestPoints none{TriangleMesh{}};
  EXPECT_TRUE(none.empty());
  EXPECT_EQ(none.at({0, 0, 0}).triangle, ClosestPoint{}.triangle);
  EXPECT_TRUE(std::isfinite(none.at({0, 0, 0}).distance));
  const ClosestPoints box(test::make_box({-1, -1, -1}, {1, 1, 1}));
  EXPECT_EQ(box.at({0, kNan, 0}).triangle, ClosestPoint{}.triangle);
  EXPECT_EQ(box.at({0, std::numeric_limits<float>::infinity(), 0}).triangle, ClosestPoint{}.triangle);
}

TEST(ClosestPoints, TrianglesThatAreNotFiniteDoNotCount) {
  TriangleMesh mesh = test::make_box({-1, -1, -1}, {1, 1, 1});
  mesh.positions[0] = {kNan, -1, -1};
  for (int i = 0; i < 3; ++i) mesh.indices.insert(mesh.indices.begin(), {0, 0, 0});
  const ClosestPoint found = ClosestPoints(mesh).at({1.5f, 0.0f, 0.0f});
  EXPECT_EQ(found.distance, 0.5f);
  EXPECT_TRUE(found.triangle == 13 || found.triangle == 14) << found.triangle;  // as numbered in the mesh: +x
}

TEST(ClosestPoints, DegenerateTrianglesAreLinesAndPoints) {
  const ClosestPoints line(TriangleMesh{"", {{0, 0, 0}, {2, 0, 0}, {1, 0, 0}}, {}, {0, 1, 2}});
  EXPECT_FLOAT_EQ(line.at({1.5f, 3, 4}).distance, 5.0f);
  EXPECT_FLOAT_EQ(line.at({-3, 4, 0}).distance, 5.0f);
  const ClosestPoints point(TriangleMesh{"", {{1, 1, 1}}, {}, {0, 0, 0}});
  EXPECT_FLOAT_EQ(point.at({1, 1, 3}).distance, 2.0f);
}

TEST(ClosestPointOnTriangle, InEachOfItsRegions) {
  const glm::dvec3 a(0, 0, 0), b(2, 0, 0), c(0, 2, 0);
  const auto at = [&](double x, double y) { return closest_point_on_triangle({x, y, 1.0}, a, b, c); };
  const auto expect = [](const glm::dvec3& found, double x, double y) {
    EXPECT_NEAR(found.x, x, 1e-12);
    EXPECT_NEAR(found.y, y, 1e-12);
    EXPECT_EQ(found.z, 0.0);
  };
  expect(at(0.5, 0.75), 0.5, 0.75);
  expect(at(-1, -1), 0, 0);
  expect(at(4, -1), 2, 0);
  expect(at(4, 1), 2, 0);
  expect(at(-1, 4), 0, 2);
  expect(at(1, -3), 1, 0);
  expect(at(-3, 1.5), 0, 1.5);
  expect(at(2, 2), 1, 1);
}

TEST(ClosestPointOnTriangle, NoPointOfItIsNearer) {
  test::Numbers numbers(4);
  for (int i = 0; i < 400; ++i) {
    const glm::dvec3 a = numbers.point(-1, 1), b = numbers.point(-1, 1);
    // Some are needles.
    const glm::dvec3 offset = numbers.point(-1, 1);
    const glm::dvec3 c = i % 3 == 0 ? glm::mix(a, b, 0.3) + 1e-6 * offset : offset;
    const glm::dvec3 p = numbers.point(-2, 2);
    const double found = glm::distance(p, closest_point_on_triangle(p, a, b, c));
    for (int u = 0; u <= 20; ++u) {
      for (int v = 0; u + v <= 20; ++v) {
        EXPECT_LE(found, glm::distance(p, a + u / 20.0 * (b - a) + v / 20.0 * (c - a)) + 1e-9);
      }
    }
  }
}

TEST(ClosestPoints, ASphereFromItsCentreAndFromAfar) {
  const ClosestPoints sphere(test::make_sphere(1.0f, 64, 96));
  EXPECT_NEAR(sphere.at({0, 0, 0}).distance, 1.0, 2e-3);
  EXPECT_NEAR(sphere.at({0, 0, 5}).distance, 4.0, 1e-6);
  EXPECT_NEAR(sphere.at({0, 1000, 0}).distance, 999.0, 1e-3);
}

TEST(ClosestPoints, AsFarAsTheNearestOfAllTriangles) {
  for (const TriangleMesh& mesh : {test::make_torus(1.0f, 0.3f, 40, 20), test::make_soup(300, 7), test::make_soup(9, 1),
                                   test::make_sphere(0.01f, 10, 12, {1, 0, 0})}) {
    const ClosestPoints tree(mesh);
    test::Numbers numbers(11);
    for (int i = 0; i < 500; ++i) {
      const glm::vec3 p = numbers.point(-1.5f, 1.5f);
      const double expected = exact_distance(mesh, p);
      const ClosestPoint found = tree.at(p);
      EXPECT_NEAR(found.distance, expected, 1e-6 * expected + 1e-9);
      EXPECT_NEAR(glm::distance(glm::dvec3(p), glm::dvec3(found.position)), expected, 1e-6);
      // The triangle named is the one that the point lies on.
      const std::size_t t = 3 * std::size_t{found.triangle};
      EXPECT_NEAR(glm::distance(glm::dvec3(p), closest_point_on_triangle(p, mesh.positions[mesh.indices[t]],
                                                                         mesh.positions[mesh.indices[t + 1]],
                                                                         mesh.positions[mesh.indices[t + 2]])),
                  expected, 1e-9);
    }
  }
}

TEST(ClosestPoints, FiniteWhateverTheSize) {
  for (const float size : {1e-30f, 1e18f, 1e30f, 3e38f}) {
    TriangleMesh mesh = test::make_soup(40, 2);
    for (glm::vec3& p : mesh.positions) p *= size;
    const ClosestPoints tree(mesh);
    for (const glm::vec3& p : {glm::vec3(0.0f), glm::vec3(-size), mesh.positions[0]}) {
      const ClosestPoint found = tree.at(p);
      EXPECT_TRUE(std::isfinite(found.distance)) << size;
      EXPECT_LT(found.triangle, 40u);
    }
  }
}

}  // namespace
}  // namespace fascicle
