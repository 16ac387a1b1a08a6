#include "engine/geometry/slice_mesh.hpp"

#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include <glm/ext/matrix_transform.hpp>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "tests/support/shapes.hpp"

namespace fascicle {
namespace {

SlicePlane level(double z) { return {{0, 0, z}, {1, 0, 0}, {0, 1, 0}}; }

// Each segment of a loop lies in the triangle named for it, and in the plane.
void expect_segments_in_triangles(const TriangleMesh& mesh, const SlicePlane& plane, const SliceLoop& loop) {
  ASSERT_EQ(loop.triangles.size() + (loop.closed ? 0 : 1), loop.points.size());
  const glm::dvec3 n = glm::cross(plane.u, plane.v);
  for (std::size_t i = 0; i < loop.triangles.size(); ++i) {
    const std::size_t t = 3 * std::size_t{loop.triangles[i]};
    const glm::dvec3 a = mesh.positions[mesh.indices[t]], b = mesh.positions[mesh.indices[t + 1]],
                     c = mesh.positions[mesh.indices[t + 2]];
    for (const glm::dvec2& point : {loop.points[i], loop.points[(i + 1) % loop.points.size()]}) {
      const glm::dvec3 p = plane.origin + point.x * plane.u + point.y * plane.v;
      const glm::dvec3 face = glm::cross(b - a, c - a);
      EXPECT_NEAR(glm::dot(p - a, glm::normalize(face)), 0.0, 1e-6);
      // The areas of the parts that p makes of the triangle sum to it.
      const double parts = glm::length(glm::cross(b - p, c - p)) + glm::length(glm::cross(c - p, a - p)) +
                           glm::length(glm::cross(a - p, b - p));
      EXPECT_NEAR(parts, glm::length(face), 1e-6 * (1.0 + glm::length(face)));
      EXPECT_NEAR(glm::dot(p - plane.origin, n), 0.0, 1e-9);
    }
  }
}

TEST(SliceMesh, NothingAndPlanesThatMissGiveNothing) {
  EXPECT_TRUE(slice_mesh({}, level(0)).empty());
  const TriangleMesh box = test::make_box({-1, -1, -1}, {1, 1, 1});
  EXPECT_TRUE(slice_mesh(box, level(1.5)).empty());
  EXPECT_TRUE(slice_mesh(box, level(-1.5)).empty());
  EXPECT_TRUE(slice_mesh(box, level(std::numeric_limits<double>::quiet_NaN())).empty());
  EXPECT_TRUE(slice_mesh(box, {glm::dvec3(0.0), glm::dvec3(0.0), glm::dvec3(0.0)}).empty());
}

TEST(SliceMesh, TrianglesThatAreNotFiniteLeaveAChain) {
  TriangleMesh mesh = test::make_box({-1, -1, -1}, {1, 1, 1});
  mesh.positions.push_back({std::numeric_limits<float>::quiet_NaN(), 0, 0});
  mesh.indices[33] = 8;  // one of +x
  const auto loops = slice_mesh(mesh, level(0));
  ASSERT_EQ(loops.size(), 1u);
  EXPECT_FALSE(loops[0].closed);
  EXPECT_NEAR(loops[0].perimeter, 7.0, 1e-12);
  EXPECT_NEAR(loops[0].area, 4.0, 1e-12);  // closed straight
}

TEST(SliceMesh, DegenerateTrianglesHaveNoLength) {
  const TriangleMesh needle{"", {{0, 0, -1}, {0, 0, 1}}, {}, {0, 1, 1, 0, 0, 1}};
  EXPECT_TRUE(slice_mesh(needle, level(0)).empty());
}

TEST(SliceMesh, ABoxGivesASquare) {
  const TriangleMesh box = test::make_box({0, 0, 0}, {1, 2, 3});
  const auto loops = slice_mesh(box, level(1.3));
  ASSERT_EQ(loops.size(), 1u);
  EXPECT_TRUE(loops[0].closed);
  EXPECT_NEAR(loops[0].area, 2.0, 1e-12);
  EXPECT_NEAR(loops[0].perimeter, 6.0, 1e-12);
  EXPECT_NEAR(loops[0].centroid.x, 0.5, 1e-12);
  EXPECT_NEAR(loops[0].centroid.y, 1.0, 1e-12);
  EXPECT_EQ(loops[0].points.size(), 8u);  // four walls of two triangles
  expect_segments_in_triangles(box, level(1.3), loops[0]);
}

TEST(SliceMesh, InsideOutTurnsTheOtherWay) {
  const auto loops = slice_mesh(test::inside_out(test::make_box({0, 0, 0}, {1, 2, 3})), level(1.3));
  ASSERT_EQ(loops.size(), 1u);
  EXPECT_NEAR(loops[0].area, -2.0, 1e-12);
}

// What lies in the plane counts as just above it: so the box's bottom is missed and its top is met.
TEST(SliceMesh, AFaceInThePlaneIsMetFromBelow) {
  const TriangleMesh box = test::make_box({0, 0, 0}, {1, 2, 3});
  EXPECT_TRUE(slice_mesh(box, level(0)).empty());
  const auto loops = slice_mesh(box, level(3));
  ASSERT_EQ(loops.size(), 1u);
  EXPECT_TRUE(loops[0].closed);
  EXPECT_NEAR(loops[0].area, 2.0, 1e-12);
  EXPECT_NEAR(loops[0].perimeter, 6.0, 1e-12);
}

TEST(SliceMesh, ASphereThroughItsVertices) {
  const TriangleMesh sphere = test::make_sphere(2.0f, 40, 64);
  const auto equator = slice_mesh(sphere, level(0));
  ASSERT_EQ(equator.size(), 1u);
  EXPECT_TRUE(equator[0].closed);
  EXPECT_NEAR(equator[0].area, 4.0 * std::numbers::pi, 0.03);
  EXPECT_NEAR(equator[0].perimeter, 4.0 * std::numbers::pi, 0.02);
  // Through both poles and the vertices of two meridians.
  const auto meridian = slice_mesh(sphere, {{0, 0, 0}, {1, 0, 0}, {0, 0, 1}});
  ASSERT_EQ(meridian.size(), 1u);
  EXPECT_TRUE(meridian[0].closed);
  EXPECT_NEAR(meridian[0].area, 4.0 * std::numbers::pi, 0.03);
  // At the pole: a point, which has no length.
  EXPECT_TRUE(slice_mesh(sphere, level(2.0)).empty());
}

TEST(SliceMesh, EveryLoopOfAClosedMeshCloses) {
  const TriangleMesh torus = test::make_torus(1.0f, 0.4f, 24, 12);
  test::Numbers numbers(5);
  for (int i = 0; i < 300; ++i) {
    // Through a vertex, or through three.
    const auto vertex = [&] {
      const float count = static_cast<float>(torus.positions.size());
      return glm::dvec3(torus.positions[static_cast<std::size_t>(numbers.next() * count)]);
    };
    const glm::dvec3 a = vertex();
    const glm::dvec3 normal =
        i % 2 == 0 ? glm::dvec3(numbers.point(-1, 1)) : glm::cross(vertex() - a, vertex() - a);
    const SlicePlane plane = plane_across(a, normal);
    for (const SliceLoop& loop : slice_mesh(torus, plane)) {
      EXPECT_TRUE(loop.closed);
      EXPECT_TRUE(std::isfinite(loop.area) && std::isfinite(loop.perimeter) && std::isfinite(loop.centroid.x));
      expect_segments_in_triangles(torus, plane, loop);
    }
  }
}

TEST(SliceMesh, ATorusAcrossGivesTwoCirclesAndFlatARing) {
  const TriangleMesh torus = test::make_torus(2.0f, 0.5f, 200, 100);
  const auto across = slice_mesh(torus, {{0, 0, 0}, {1, 0, 0}, {0, 0, 1}});
  ASSERT_EQ(across.size(), 2u);
  for (const SliceLoop& loop : across) {
    EXPECT_NEAR(loop.area, 0.25 * std::numbers::pi, 2e-3);
    EXPECT_NEAR(std::abs(loop.centroid.x), 2.0, 1e-3);
  }
  auto flat = slice_mesh(torus, level(0.0));
  ASSERT_EQ(flat.size(), 2u);
  if (flat[0].area < flat[1].area) std::swap(flat[0], flat[1]);
  EXPECT_NEAR(flat[0].area, 6.25 * std::numbers::pi, 0.02);
  EXPECT_NEAR(flat[1].area, -2.25 * std::numbers::pi, 0.02);  // a hole
}

TEST(SliceMesh, OpenMeshesGiveChains) {
  const std::array<glm::vec2, 4> square = {glm::vec2{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  const TriangleMesh wall = test::make_wall(square, 0.0f, 3.0f, 3);
  const auto across = slice_mesh(wall, level(1.5));
  ASSERT_EQ(across.size(), 1u);
  EXPECT_TRUE(across[0].closed);
  const SlicePlane lengthwise{{0, 0.5, 0}, {1, 0, 0}, {0, 0, 1}};
  const auto along = slice_mesh(wall, lengthwise);
  ASSERT_EQ(along.size(), 2u);
  for (const SliceLoop& chain : along) {
    EXPECT_FALSE(chain.closed);
    EXPECT_NEAR(chain.perimeter, 3.0, 1e-12);
    EXPECT_EQ(chain.points.size(), chain.triangles.size() + 1);
    expect_segments_in_triangles(wall, lengthwise, chain);
  }
}

TEST(SliceMesh, AFlippedTriangleChangesNothing) {
  TriangleMesh sphere = test::make_sphere(1.0f, 12, 16);
  const auto sound = slice_mesh(sphere, level(0.1));
  for (std::size_t t = 0; t < sphere.indices.size(); t += 21) std::swap(sphere.indices[t], sphere.indices[t + 1]);
  const auto flipped = slice_mesh(sphere, level(0.1));
  ASSERT_EQ(flipped.size(), 1u);
  EXPECT_TRUE(flipped[0].closed);
  EXPECT_NEAR(flipped[0].area, sound[0].area, 1e-12);
  EXPECT_EQ(flipped[0].points.size(), sound[0].points.size());
}

TEST(SliceMesh, BoxesThatShareAnEdgeStayApart) {
  // Corner to corner along z: four walls meet in one edge of four triangles.
  TriangleMesh mesh = test::join(test::make_box({0, 0, 0}, {1, 1, 1}), test::make_box({1, 1, 0}, {2, 2, 1}));
  for (std::uint32_t& index : mesh.indices) {
    if (index == 8) index = 3;
    if (index == 12) index = 7;
  }
  const auto loops = slice_mesh(mesh, level(0.5));
  ASSERT_EQ(loops.size(), 2u);
  for (const SliceLoop& loop : loops) {
    EXPECT_TRUE(loop.closed);
    EXPECT_NEAR(loop.area, 1.0, 1e-12);
  }
}

TEST(SliceMesh, AnySoupGivesEverySegmentOnce) {
  for (std::uint32_t seed = 0; seed < 50; ++seed) {
    const TriangleMesh soup = test::make_soup(100, seed);
    const SlicePlane plane = plane_across({0.1, 0, 0}, {1, 0.3, -0.2});
    const glm::dvec3 n = glm::cross(plane.u, plane.v);
    std::size_t cut = 0, walked = 0;
    for (std::size_t t = 0; t < soup.indices.size(); t += 3) {
      int above = 0;
      for (std::size_t i = 0; i < 3; ++i) {
        above += glm::dot(glm::dvec3(soup.positions[soup.indices[t + i]]) - plane.origin, n) >= 0.0 ? 1 : 0;
      }
      const bool degenerate = soup.indices[t] == soup.indices[t + 1] || soup.indices[t] == soup.indices[t + 2] ||
                              soup.indices[t + 1] == soup.indices[t + 2];
      if (above > 0 && above < 3 && !degenerate) ++cut;
    }
    for (const SliceLoop& loop : slice_mesh(soup, plane)) {
      for (const std::uint32_t t : loop.triangles) {
        const std::uint32_t* corner = &soup.indices[3 * std::size_t{t}];
        if (corner[0] != corner[1] && corner[0] != corner[2] && corner[1] != corner[2]) ++walked;
      }
      EXPECT_TRUE(std::isfinite(loop.area) && std::isfinite(loop.centroid.y));
    }
    EXPECT_EQ(walked, cut);
  }
}

TEST(SliceMesh, PlacesFarFromTheOriginLoseNothing) {
  const glm::mat4 far = glm::translate(glm::mat4(1.0f), glm::vec3(512, -256, 128));
  const auto loops = slice_mesh(test::moved(test::make_box({0, 0, 0}, {0.25f, 0.25f, 0.25f}), far), level(128.125));
  ASSERT_EQ(loops.size(), 1u);
  EXPECT_NEAR(loops[0].area, 0.0625, 1e-9);
  EXPECT_NEAR(loops[0].centroid.x, 512.125, 1e-9);
}

TEST(PlaneAcross, IsSquareAndOfUnitLength) {
  for (const glm::dvec3& n :
       {glm::dvec3(0, 0, 5), glm::dvec3(1, 1, 1), glm::dvec3(-3, 0.1, 0), glm::dvec3(0, -2, 1e-9)}) {
    const SlicePlane plane = plane_across({1, 2, 3}, n);
    EXPECT_NEAR(glm::length(plane.u), 1.0, 1e-12);
    EXPECT_NEAR(glm::length(plane.v), 1.0, 1e-12);
    EXPECT_NEAR(glm::distance(glm::cross(plane.u, plane.v), glm::normalize(n)), 0.0, 1e-12);
  }
  EXPECT_EQ(glm::cross(plane_across({}, {0, 0, 0}).u, plane_across({}, {0, 0, 0}).v), glm::dvec3(0, 0, 1));
}

}  // namespace
}  // namespace fascicle
