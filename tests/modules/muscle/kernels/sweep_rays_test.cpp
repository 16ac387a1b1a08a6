#include "modules/muscle/kernels/sweep_rays.hpp"

#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

#include "engine/geometry/triangle_tree.hpp"

namespace fascicle::muscle {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr SweepTriangle kTriangle{glm::vec3(0, 0, 0), glm::vec3(1, 0, 0), glm::vec3(0, 1, 0)};

using Flags = std::vector<std::uint8_t>;

// A round section square to z; vertex 0 on +x.
std::vector<glm::vec3> ring(std::size_t count, float radius, float z) {
  std::vector<glm::vec3> vertices;
  for (std::size_t i = 0; i < count; ++i) {
    const float theta = 2.0f * std::numbers::pi_v<float> * static_cast<float>(i) / static_cast<float>(count);
    vertices.emplace_back(radius * std::cos(theta), radius * std::sin(theta), z);
  }
  return vertices;
}

// A square plate across the whole muscle in the plane x = place.
std::vector<SweepTriangle> plate(float place) {
  const glm::vec3 a(place, -1, -1), b(place, 1, -1), c(place, 1, 1), d(place, -1, 1);
  return {{a, b, c}, {a, c, d}};
}

TEST(SweepRays, NotFiniteNeverCrosses) {
  for (int axis = 0; axis < 3; ++axis) {
    SweepEdge edge{{0.25f, 0.25f, -1.0f}, {0.25f, 0.25f, 1.0f}};
    ASSERT_TRUE(crosses(edge, kTriangle));
    SweepTriangle triangle = kTriangle;
    triangle[1][axis] = kNan;
    EXPECT_FALSE(crosses(edge, triangle));
    edge.from[axis] = kNan;
    EXPECT_FALSE(crosses(edge, kTriangle));
    edge.from[axis] = std::numeric_limits<float>::infinity();
    EXPECT_FALSE(crosses(edge, kTriangle));
  }
}

TEST(SweepRays, NothingToCross) {
  const SweepEdge edge{{0.25f, 0.25f, -1.0f}, {0.25f, 0.25f, 1.0f}};
  EXPECT_FALSE(crosses(edge, {glm::vec3(0), glm::vec3(1), glm::vec3(2)}));  // no area
  EXPECT_FALSE(crosses({edge.from, edge.from}, kTriangle));                 // no length
  EXPECT_FALSE(crosses({{0, 0, 0}, {1, 0, 0}}, kTriangle));                 // in its plane
  Flags hits(1, 0);
  mark_crossings(std::vector{edge}, std::span<const SweepTriangle>{}, hits);
  mark_crossings(std::vector{edge}, TriangleTree{}, glm::mat4(1.0f), hits);
  EXPECT_EQ(hits[0], 0);
}

TEST(SweepRays, OnlyWithinTheEdgesLength) {
  EXPECT_TRUE(crosses({{0.25f, 0.25f, -0.1f}, {0.25f, 0.25f, 0.1f}}, kTriangle));
  EXPECT_TRUE(crosses({{0.25f, 0.25f, 0.1f}, {0.25f, 0.25f, -0.1f}}, kTriangle));  // from behind too
  EXPECT_TRUE(crosses({{0.25f, 0.25f, -0.1f}, {0.25f, 0.25f, 0.0f}}, kTriangle));  // it just touches
  EXPECT_FALSE(crosses({{0.25f, 0.25f, -0.2f}, {0.25f, 0.25f, -0.1f}}, kTriangle));
  EXPECT_FALSE(crosses({{0.25f, 0.25f, 0.1f}, {0.25f, 0.25f, 0.2f}}, kTriangle));
  EXPECT_FALSE(crosses({{0.75f, 0.75f, -1.0f}, {0.75f, 0.75f, 1.0f}}, kTriangle));
}

TEST(SweepRays, EdgesGoRoundAndToTheNextVertexOfTheNeighbour) {
  const std::vector<glm::vec3> here = ring(6, 1.0f, 0.0f), next = ring(6, 1.0f, 2.0f);
  std::vector<SweepEdge> latitudinal(6), diagonal(6);
  sweep_edges(here, next, latitudinal, diagonal);
  for (std::size_t i = 0; i < 6; ++i) {
    EXPECT_EQ(latitudinal[i].from, here[i]);
    EXPECT_EQ(latitudinal[i].to, here[(i + 1) % 6]);
    EXPECT_EQ(diagonal[i].from, here[i]);
    EXPECT_EQ(diagonal[i].to, next[(i + 1) % 6]);
  }
}

TEST(SweepRays, APlateHitsTheEdgesThatItCuts) {
  constexpr std::size_t kCount = 8;
  const std::vector<glm::vec3> here = ring(kCount, 0.02f, 0.0f), next = ring(kCount, 0.02f, 0.05f);
  std::vector<SweepEdge> latitudinal(kCount), diagonal(kCount);
  sweep_edges(here, next, latitudinal, diagonal);
  Flags latitudinal_hits(kCount, 0), diagonal_hits(kCount, 0), vertices(kCount, 7);
  const std::vector<SweepTriangle> triangles = plate(0.018f);
  mark_crossings(latitudinal, triangles, latitudinal_hits);
  mark_crossings(diagonal, triangles, diagonal_hits);
  // Only vertex 0 is beyond x = 0.018: edges 7 -> 0 and 0 -> 1 are cut.
  EXPECT_EQ(latitudinal_hits, (Flags{1, 0, 0, 0, 0, 0, 0, 1}));
  EXPECT_EQ(diagonal_hits, (Flags{1, 0, 0, 0, 0, 0, 0, 1}));
  mark_vertices(latitudinal_hits, vertices);
  EXPECT_EQ(vertices, (Flags{1, 1, 0, 0, 0, 0, 0, 1}));
}

TEST(SweepRays, SeveralPartnersAddUp) {
  const std::vector<glm::vec3> here = ring(8, 0.02f, 0.0f);
  std::vector<SweepEdge> latitudinal(8), diagonal(8);
  sweep_edges(here, here, latitudinal, diagonal);
  Flags hits(8, 0);
  mark_crossings(latitudinal, plate(0.018f), hits);
  mark_crossings(latitudinal, plate(-0.018f), hits);
  EXPECT_EQ(hits, (Flags{1, 0, 0, 1, 1, 0, 0, 1}));
}

TEST(SweepRays, TheSurfaceBetweenSectionsIsClosedRound) {
  constexpr std::size_t kCount = 6;
  std::vector<SweepTriangle> triangles(2 * kCount);
  segment_triangles(ring(kCount, 0.02f, 0.0f), ring(kCount, 0.02f, 0.05f), triangles);
  for (int degree = 1; degree < 360; degree += 7) {
    const float theta = glm::radians(static_cast<float>(degree));
    const SweepEdge out{{0, 0, 0.02f}, {0.03f * std::cos(theta), 0.03f * std::sin(theta), 0.02f}};
    Flags hits(1, 0);
    mark_crossings(std::vector{out}, triangles, hits);
    EXPECT_EQ(hits[0], 1) << degree;
  }
}

// Against all triangles, in a frame of the tree's own.
TEST(SweepRays, TheTreeAgreesWithAllTriangles) {
  std::mt19937 random(3);
  std::uniform_real_distribution<float> place(-0.2f, 0.2f), step(-0.03f, 0.03f);
  const auto point = [&] { return glm::vec3(place(random), place(random), place(random)); };
  const auto nearby = [&](const glm::vec3& of) { return of + glm::vec3(step(random), step(random), step(random)); };
  TriangleMesh mesh;
  std::vector<SweepTriangle> triangles;
  const glm::mat4 to_world = glm::rotate(glm::translate(glm::mat4(1.0f), {0.5f, 1.0f, -0.3f}), 0.8f,
                                         glm::normalize(glm::vec3(1, 2, 3)));
  for (std::uint32_t t = 0; t < 2000; ++t) {
    const glm::vec3 a = point();
    const SweepTriangle triangle{a, nearby(a), nearby(a)};
    triangles.push_back(triangle);
    for (std::uint32_t corner = 0; corner < 3; ++corner) {
      mesh.positions.push_back(triangle[corner]);
      mesh.indices.push_back(3 * t + corner);
    }
  }
  const TriangleTree tree = build_triangle_tree(mesh);
  std::vector<SweepEdge> edges, world;
  for (int i = 0; i < 3000; ++i) {
    const glm::vec3 from = point();
    // Every third along an axis.
    glm::vec3 to = nearby(from);
    if (i % 3 == 0) to.y = from.y, to.z = from.z;
    edges.push_back({from, to});
    world.push_back({glm::vec3(to_world * glm::vec4(from, 1)), glm::vec3(to_world * glm::vec4(to, 1))});
  }
  Flags expected(edges.size(), 0), here(edges.size(), 0), there(edges.size(), 0);
  mark_crossings(edges, triangles, expected);
  mark_crossings(edges, tree, glm::mat4(1.0f), here);
  mark_crossings(world, tree, glm::inverse(to_world), there);
  EXPECT_EQ(here, expected);
  int crossed = 0, different = 0;
  for (std::size_t i = 0; i < expected.size(); ++i) {
    crossed += expected[i];
    different += expected[i] != there[i];
  }
  EXPECT_GT(crossed, 300);
  EXPECT_LT(crossed, 2700);
  EXPECT_LE(different, 2);  // edges that graze a triangle, by the transform's rounding
}

}  // namespace
}  // namespace fascicle::muscle
