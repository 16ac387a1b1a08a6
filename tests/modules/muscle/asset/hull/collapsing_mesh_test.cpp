#include "modules/muscle/asset/hull/collapsing_mesh.hpp"

#include <gtest/gtest.h>

#include "tests/modules/muscle/asset/hull/hull_checks.hpp"
#include "tests/support/shapes.hpp"

namespace fascicle::muscle {
namespace {

TriangleMesh octahedron() {
  TriangleMesh mesh;
  mesh.positions = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
  mesh.indices = {0, 2, 4, 2, 1, 4, 1, 3, 4, 3, 0, 4, 2, 0, 5, 1, 2, 5, 3, 1, 5, 0, 3, 5};
  return mesh;
}

TEST(CollapsingMesh, RefusesEdgesThatAreNone) {
  CollapsingMesh mesh(octahedron(), glm::dvec3(0.0));
  EXPECT_FALSE(mesh.can_collapse(0, 1));
  EXPECT_FALSE(mesh.can_collapse(4, 5));
  EXPECT_TRUE(mesh.can_collapse(0, 2));
  EXPECT_TRUE(mesh.can_collapse(2, 0));
}

TEST(CollapsingMesh, RefusesTheLastFourVertices) {
  CollapsingMesh mesh(test::make_corner(1.0f), glm::dvec3(0.0));
  for (std::uint32_t u = 0; u < 4; ++u) {
    for (std::uint32_t v = 0; v < u; ++v) EXPECT_FALSE(mesh.can_collapse(u, v));
  }
}

// Two pyramids on a triangle: its sides have a third common neighbour, itself, and the tips have three triangles.
TEST(CollapsingMesh, RefusesToFoldTwoTrianglesOntoEachOther) {
  TriangleMesh pyramids;
  pyramids.positions = {{1, 0, 0}, {-1, 1, 0}, {-1, -1, 0}, {0, 0, 1}, {0, 0, -1}};
  pyramids.indices = {0, 1, 3, 1, 2, 3, 2, 0, 3, 1, 0, 4, 2, 1, 4, 0, 2, 4};
  ASSERT_EQ(test::manifold_fault(pyramids), "");
  CollapsingMesh mesh(pyramids, glm::dvec3(0.0));
  EXPECT_FALSE(mesh.can_collapse(0, 1));
  EXPECT_FALSE(mesh.can_collapse(1, 2));
  EXPECT_FALSE(mesh.can_collapse(2, 0));
  ASSERT_TRUE(mesh.can_collapse(0, 3));
  mesh.collapse(0, 3, {0.5, 0, 0.5});
  EXPECT_EQ(mesh.vertex_count(), 4u);
  EXPECT_EQ(test::manifold_fault(mesh.finish()), "");
}

// A ring of three triangles' width that is no triangle itself: collapsing one of its edges would pinch the tube off.
TEST(CollapsingMesh, RefusesToPinchATubeOff) {
  const TriangleMesh tube = test::make_torus(1.0f, 0.2f, 8, 3);
  CollapsingMesh mesh(tube, glm::dvec3(0.0));
  EXPECT_FALSE(mesh.can_collapse(0, 1));
  EXPECT_TRUE(mesh.can_collapse(0, 3)) << "along the tube";
}

TEST(CollapsingMesh, CollapseMakesANewVertex) {
  CollapsingMesh mesh(octahedron(), glm::dvec3(0.5, 0.0, 0.0));
  const std::uint32_t before = mesh.revision(1);
  const std::uint32_t made = mesh.collapse(0, 2, {0.5, 1.0, 0.0});
  EXPECT_EQ(made, 6u);
  EXPECT_FALSE(mesh.alive(0));
  EXPECT_FALSE(mesh.alive(2));
  EXPECT_TRUE(mesh.alive(made));
  EXPECT_EQ(mesh.vertex_count(), 5u);
  EXPECT_EQ(mesh.fan(made).size(), 4u);
  EXPECT_EQ(mesh.fan(4).size(), 3u);
  EXPECT_GT(mesh.revision(1), before);
  const TriangleMesh left = mesh.finish();
  EXPECT_EQ(test::manifold_fault(left), "");
  EXPECT_EQ(left.indices.size(), 18u);
  EXPECT_EQ(left.positions.back(), glm::vec3(1.0f, 1.0f, 0.0f)) << "in the frame of the mesh";
  EXPECT_EQ(left.positions.front(), glm::vec3(-1.0f, 0.0f, 0.0f)) << "what was not touched is what it was";
}

TEST(CollapsingMesh, StaysManifoldToTheEnd) {
  const TriangleMesh sphere = test::make_sphere(1.0f, 8, 10);
  CollapsingMesh mesh(sphere, glm::dvec3(0.0));
  test::Numbers numbers(5);
  for (int turn = 0; turn < 20000 && mesh.vertex_count() > 4; ++turn) {
    const auto u = static_cast<std::uint32_t>(numbers.next() * static_cast<float>(mesh.vertex_end()));
    if (!mesh.alive(u)) continue;
    const auto& triangle = mesh.triangle(mesh.fan(u)[0]);
    const std::uint32_t v = triangle[0] == u ? triangle[1] : triangle[0];
    if (!mesh.can_collapse(u, v)) continue;
    mesh.collapse(u, v, 0.5 * (mesh.position(u) + mesh.position(v)));
    ASSERT_EQ(test::manifold_fault(mesh.finish()), "") << mesh.vertex_count();
  }
  EXPECT_EQ(mesh.vertex_count(), 4u);
}

}  // namespace
}  // namespace fascicle::muscle
