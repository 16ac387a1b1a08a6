#include "modules/muscle/measure/solid_tree.hpp"

#include <cmath>

#include <gtest/gtest.h>
#include <glm/gtc/matrix_transform.hpp>

#include "engine/geometry/closest_point.hpp"
#include "engine/geometry/winding_number.hpp"
#include "tests/support/shapes.hpp"

namespace fascicle::muscle {
namespace {

void expect_windings(const TriangleMesh& mesh, const SolidTree& tree, int count) {
  test::Numbers numbers(7);
  for (int i = 0; i < count; ++i) {
    const glm::vec3 point = numbers.point(-1.2f, 1.2f);
    ASSERT_EQ(tree.windings(point), std::lround(winding_number(mesh, glm::dvec3(point)))) << i;
  }
}

TEST(SolidTree, NoTrianglesHaveNoInside) {
  const SolidTree none{TriangleMesh{}};
  EXPECT_EQ(none.windings({0, 0, 0}), 0);
  EXPECT_GT(none.distance_beyond({0, 0, 0}, 1.0), 1e30);
}

TEST(SolidTree, CrossingsAreTheWindingNumberOfClosedSurfaces) {
  const TriangleMesh sphere = test::make_sphere(0.9f, 12, 18), torus = test::make_torus(0.7f, 0.3f, 24, 12);
  const TriangleMesh beside = test::moved(sphere, glm::translate(glm::mat4(1.0f), {0.4f, 0.3f, 0.1f}));
  for (const TriangleMesh& mesh : {sphere, torus, test::inside_out(sphere), test::join(sphere, beside),
                                   test::join(sphere, test::inside_out(torus))}) {
    expect_windings(mesh, SolidTree(mesh), 2000);
  }
}

// A surface that passes through itself, as a muscle's outlines may: any places at all for a sphere's vertices.
TEST(SolidTree, CrossingsAreTheWindingNumberOfCrumpledSurfaces) {
  TriangleMesh mesh = test::make_sphere(0.9f, 8, 12);
  SolidTree tree(mesh);
  test::Numbers numbers(3);
  for (glm::vec3& p : mesh.positions) p = numbers.point(-1.0f, 1.0f);
  tree.move(mesh.positions);
  expect_windings(mesh, tree, 2000);
}

// Rays through vertices and along edges and faces: points above and below all of them.
TEST(SolidTree, NoRaySlipsBetweenTriangles) {
  const TriangleMesh box = test::make_box({-1, -1, -1}, {1, 1, 1});
  const TriangleMesh sphere = test::make_sphere(1.0f, 16, 16);
  const SolidTree box_tree(box), sphere_tree(sphere);
  for (float x = -0.75f; x < 1.0f; x += 0.25f) {
    for (float y = -0.75f; y < 1.0f; y += 0.25f) {
      EXPECT_EQ(box_tree.windings({x, y, 0.3f}), 1);
      EXPECT_EQ(box_tree.windings({x, y, -1.5f}), 0);
      EXPECT_EQ(box_tree.windings({x, y, 1.5f}), 0);
    }
  }
  for (const glm::vec3& p : sphere.positions) EXPECT_EQ(sphere_tree.windings(glm::vec3(p.x, p.y, -2.0f)), 0);
  for (const glm::vec3& p : sphere.positions) {
    if (std::abs(p.z) < 0.9f) continue;
    EXPECT_EQ(sphere_tree.windings(glm::vec3(p.x, p.y, 0.0f)), 1);
  }
}

TEST(SolidTree, DistancesAreThoseToTheClosestPointOrEnough) {
  const TriangleMesh soup = test::make_soup(200, 5);
  TriangleMesh moved = soup;
  SolidTree tree(soup);
  for (glm::vec3& p : moved.positions) p = glm::vec3(p.y, 0.5f * p.z, -p.x);
  tree.move(moved.positions);
  const ClosestPoints closest(moved);
  test::Numbers numbers(9);
  for (int i = 0; i < 2000; ++i) {
    const glm::vec3 point = numbers.point(-2.0f, 2.0f);
    const auto exact = static_cast<double>(closest.at(point).distance);
    EXPECT_NEAR(tree.distance_beyond(point, 0.0), exact, 1e-6);
    const double found = tree.distance_beyond(point, 0.2);
    if (exact > 0.2) {
      EXPECT_NEAR(found, exact, 1e-6);
    } else {
      EXPECT_LE(found, 0.2);
    }
  }
}

}  // namespace
}  // namespace fascicle::muscle
