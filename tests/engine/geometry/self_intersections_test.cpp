#include "engine/geometry/self_intersections.hpp"

#include <gtest/gtest.h>

#include <array>
#include <vector>

#include <glm/geometric.hpp>

#include "engine/geometry/triangles_cross.hpp"
#include "engine/parallel/worker_arena.hpp"
#include "tests/support/shapes.hpp"

namespace fascicle {
namespace {

using Triangle = std::array<glm::vec3, 3>;

bool cross(const Triangle& a, const Triangle& b) {
  const std::vector<glm::vec3> positions = {a[0], a[1], a[2], b[0], b[1], b[2]};
  return triangles_cross(positions, {0, 1, 2}, {3, 4, 5});
}

SelfIntersections find(const TriangleMesh& mesh, std::size_t max_pairs = 100000) {
  return find_self_intersections(mesh.positions, mesh.indices, max_pairs);
}

const Triangle kFlat = {glm::vec3(0, 0, 0), glm::vec3(4, 0, 0), glm::vec3(0, 4, 0)};

TEST(TrianglesCross, ThroughEachOther) {
  EXPECT_TRUE(cross(kFlat, {glm::vec3(1, 1, -1), glm::vec3(1, 1, 1), glm::vec3(9, 9, 0.5f)}));
  EXPECT_TRUE(cross({glm::vec3(1, 1, -1), glm::vec3(1, 1, 1), glm::vec3(9, 9, 0.5f)}, kFlat));
  // Through the middle of an edge, and through a corner's sector from there.
  EXPECT_TRUE(cross(kFlat, {glm::vec3(2, 0, -1), glm::vec3(2, 0, 1), glm::vec3(2, 1, 0)}));
}

TEST(TrianglesCross, ApartOrTouching) {
  EXPECT_FALSE(cross(kFlat, {glm::vec3(0, 0, 1), glm::vec3(4, 0, 1), glm::vec3(0, 4, 1)}));
  EXPECT_FALSE(cross(kFlat, {glm::vec3(3, 3, -1), glm::vec3(3, 3, 1), glm::vec3(9, 9, 0)}));  // beside it
  EXPECT_FALSE(cross(kFlat, {glm::vec3(1, 1, 0), glm::vec3(1, 1, 1), glm::vec3(1, 2, 1)}));   // a corner on it
  EXPECT_FALSE(cross(kFlat, {glm::vec3(1, 1, 0), glm::vec3(2, 1, 0), glm::vec3(1, 2, 1)}));   // an edge on it
}

TEST(TrianglesCross, InOnePlane) {
  const auto moved = [](float x, float y) {
    Triangle t = kFlat;
    for (glm::vec3& p : t) p += glm::vec3(x, y, 0);
    return t;
  };
  EXPECT_TRUE(cross(kFlat, kFlat));
  EXPECT_TRUE(cross(kFlat, moved(1, 1)));
  EXPECT_TRUE(cross(kFlat, {glm::vec3(1, 1, 0), glm::vec3(1.5f, 1, 0), glm::vec3(1, 1.5f, 0)}));  // inside
  EXPECT_FALSE(cross(kFlat, moved(4, 0)));                                                        // at a corner
  EXPECT_FALSE(cross(kFlat, {glm::vec3(4, 0, 0), glm::vec3(0, 4, 0), glm::vec3(4, 4, 0)}));       // along an edge
  EXPECT_FALSE(cross(kFlat, moved(3, 3)));
}

TEST(TrianglesCross, NeighboursTouchOnly) {
  const std::vector<glm::vec3> p = {{0, 0, 0},   {1, 0, 0},       {0, 1, 0},        {0, 0, 1},
                                    {-1, -1, 0}, {0.2f, 0.2f, 1}, {0.2f, 0.2f, -1}, {0.5f, 0.1f, 0}};
  EXPECT_FALSE(triangles_cross(p, {0, 1, 2}, {1, 0, 3}));  // an edge in common
  EXPECT_FALSE(triangles_cross(p, {0, 1, 2}, {0, 3, 4}));  // a corner
  EXPECT_TRUE(triangles_cross(p, {0, 1, 2}, {0, 5, 6}));   // a corner, but the edge across passes through
  EXPECT_TRUE(triangles_cross(p, {0, 1, 2}, {1, 0, 7}));   // folded back onto its neighbour
}

// By equations, in long double: cuts the planes' common line by both triangles.
bool cross_by_line(const Triangle& a, const Triangle& b) {
  using Vec = glm::vec<3, long double>;
  const auto interval = [](const Triangle& t, const Triangle& other, const Vec& along, long double out[2]) {
    const Vec o0(other[0]), n = glm::cross(Vec(other[1]) - o0, Vec(other[2]) - o0);
    int found = 0;
    for (std::size_t k = 0; k < 3 && found < 2; ++k) {
      const Vec p(t[k]), q(t[(k + 1) % 3]);
      const long double dp = glm::dot(n, p - o0), dq = glm::dot(n, q - o0);
      if (dp * dq < 0) out[found++] = glm::dot(along, p + (q - p) * (dp / (dp - dq)));
    }
    if (found == 2 && out[0] > out[1]) std::swap(out[0], out[1]);
    return found == 2;
  };
  const auto normal = [](const Triangle& t) { return glm::cross(Vec(t[1]) - Vec(t[0]), Vec(t[2]) - Vec(t[0])); };
  const Vec along = glm::cross(normal(a), normal(b));
  long double ia[2], ib[2];
  return interval(a, b, along, ia) && interval(b, a, along, ib) && ia[0] < ib[1] && ib[0] < ia[1];
}

TEST(TrianglesCross, AgreesWithTheEquationsOnRandomTriangles) {
  test::Numbers numbers(17);
  int crossing = 0;
  for (int i = 0; i < 20000; ++i) {
    Triangle a, b;
    for (glm::vec3& p : a) p = numbers.point(-1.0f, 1.0f);
    for (glm::vec3& p : b) p = numbers.point(-1.0f, 1.0f);
    EXPECT_EQ(cross(a, b), cross_by_line(a, b));
    EXPECT_EQ(cross(a, b), cross(b, a));
    crossing += cross(a, b);
  }
  EXPECT_GT(crossing, 2000);
  EXPECT_LT(crossing, 18000);
}

TEST(SelfIntersections, OfNothingAreNone) {
  EXPECT_EQ(find({}).pairs, 0u);
  TriangleMesh one = test::make_corner(1.0f);
  one.indices.resize(3);
  EXPECT_EQ(find(one).pairs, 0u);
}

TEST(SelfIntersections, SimpleSurfacesHaveNone) {
  EXPECT_EQ(find(test::make_torus(1.0f, 0.4f, 60, 30)).pairs, 0u);
  EXPECT_EQ(find(test::make_sphere(1.0f, 40, 60)).pairs, 0u);
  EXPECT_EQ(find(test::join(test::make_sphere(1.0f, 20, 30), test::make_sphere(0.9f, 20, 30))).pairs, 0u);
  EXPECT_EQ(find(test::join(test::make_box({0, 0, 0}, {1, 1, 1}), test::make_box({1, 0, 0}, {2, 1, 1}))).pairs,
            2u);  // the common face, which is there twice (clean_mesh welds it first)
}

TEST(SelfIntersections, OverlapsAreFound) {
  EXPECT_GT(find(test::make_torus(0.3f, 0.5f, 40, 20)).pairs, 100u);  // a spindle
  EXPECT_GT(find(test::join(test::make_sphere(1.0f, 20, 30), test::make_sphere(1.0f, 20, 30, {0.5f, 0, 0}))).pairs,
            50u);
  // Boxes pushed along one axis cross nowhere: their faces overlap in their planes.
  EXPECT_GT(find(test::join(test::make_box({0, 0, 0}, {1, 1, 1}), test::make_box({0.5f, 0, 0}, {1.5f, 1, 1}))).pairs,
            7u);
}

TEST(SelfIntersections, AreAllThatTestingEveryPairFinds) {
  for (const std::uint32_t count : {2u, 5u, 40u, 300u}) {
    const TriangleMesh soup = test::make_soup(count, count);
    std::size_t expected = 0;
    const auto corners = [&](std::size_t t) {
      return std::array<std::uint32_t, 3>{soup.indices[3 * t], soup.indices[3 * t + 1], soup.indices[3 * t + 2]};
    };
    for (std::size_t a = 0; a < count; ++a) {
      for (std::size_t b = a + 1; b < count; ++b) expected += triangles_cross(soup.positions, corners(a), corners(b));
    }
    EXPECT_EQ(find(soup).pairs, expected);
    EXPECT_FALSE(find(soup).more);
  }
}

TEST(SelfIntersections, AreTheSameForAnyNumberOfThreads) {
  const TriangleMesh soup = test::make_soup(600, 5);
  const TriangleMesh spindle = test::make_torus(0.3f, 0.5f, 150, 60);  // more triangles than one round takes
  const std::size_t in_spindle = find(spindle).pairs;
  EXPECT_GT(in_spindle, 150u);
  for (const int workers : {1, 16}) {
    parallel::WorkerArena(workers).execute([&] {
      EXPECT_EQ(find(soup, 2000).pairs, 2000u);
      EXPECT_EQ(find(spindle).pairs, in_spindle);
    });
  }
}

TEST(SelfIntersections, EndAtTheLimit) {
  const TriangleMesh soup = test::make_soup(300, 1);
  const std::size_t all = find(soup).pairs;
  ASSERT_GT(all, 1000u);
  EXPECT_EQ(find(soup, 1000).pairs, 1000u);
  EXPECT_TRUE(find(soup, 1000).more);
  EXPECT_EQ(find(soup, all + 1).pairs, all);
  EXPECT_FALSE(find(soup, all + 1).more);
}

}  // namespace
}  // namespace fascicle
