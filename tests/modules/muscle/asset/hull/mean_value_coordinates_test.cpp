#include "modules/muscle/asset/hull/mean_value_coordinates.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include <glm/gtc/matrix_transform.hpp>

#include "engine/parallel/worker_arena.hpp"
#include "tests/modules/muscle/asset/hull/coordinate_rows.hpp"
#include "tests/support/shapes.hpp"

namespace fascicle::test {
namespace {

constexpr float kNone = std::numeric_limits<float>::quiet_NaN();
constexpr float kEndless = std::numeric_limits<float>::infinity();

void expect_row(const std::vector<float>& row, const std::vector<double>& wanted, double tolerance = 2.0e-7) {
  ASSERT_EQ(row.size(), wanted.size());
  for (std::size_t v = 0; v < row.size(); ++v) EXPECT_NEAR(row[v], wanted[v], tolerance) << "vertex " << v;
}

// The sum and the point, as parts of 1 and of the hull's size.
void expect_precise(const TriangleMesh& hull, std::span<const glm::vec3> points, double size, double tolerance) {
  const std::vector<float> rows = coordinates(hull, points);
  const std::size_t count = hull.positions.size();
  for (std::size_t i = 0; i < points.size(); ++i) {
    EXPECT_NEAR(sum_of(std::span(rows).subspan(i * count, count)), 1.0, tolerance) << "point " << i;
  }
  EXPECT_LE(missed(rows, hull, points), tolerance * size);
}

// A prism over a U: its inside is not convex, and the planes of its faces cut through it.
TriangleMesh make_gutter() {
  const std::vector<glm::vec2> u = {{0, 0}, {3, 0}, {3, 3}, {2, 3}, {2, 1}, {1, 1}, {1, 3}, {0, 3}};
  TriangleMesh mesh = make_wall(u, 0.0f, 1.0f);
  const std::vector<std::uint32_t> cap = {0, 1, 4, 0, 4, 5, 1, 2, 3, 1, 3, 4, 0, 5, 6, 0, 6, 7};
  for (std::size_t i = 0; i < cap.size(); i += 3) {
    mesh.indices.insert(mesh.indices.end(), {cap[i], cap[i + 2], cap[i + 1]});
    mesh.indices.insert(mesh.indices.end(), {cap[i] + 8, cap[i + 1] + 8, cap[i + 2] + 8});
  }
  return mesh;
}

std::vector<glm::vec3> points_about(std::size_t count, float lower, float upper, std::uint32_t seed) {
  Numbers numbers(seed);
  std::vector<glm::vec3> points;
  for (std::size_t i = 0; i < count; ++i) points.push_back(numbers.point(lower, upper));
  return points;
}

// --- What is none.

TEST(MeanValueCoordinates, HullWithoutVerticesHasNoWeights) {
  EXPECT_TRUE(coordinates({}, glm::vec3(1.0f)).empty());
  EXPECT_TRUE(coordinates(make_corner(1.0f), std::span<const glm::vec3>()).empty());
}

TEST(MeanValueCoordinates, HullWithoutAreaWeighsAllTheSame) {
  TriangleMesh points = make_corner(1.0f);
  points.indices.clear();
  TriangleMesh line = make_corner(1.0f);
  for (std::size_t v = 0; v < 4; ++v) line.positions[v] = glm::vec3(static_cast<float>(v), 0.0f, 0.0f);
  TriangleMesh far = make_corner(1.0f);
  far.positions[2].y = kEndless;
  TriangleMesh none = make_corner(1.0f);
  none.positions[0].x = kNone;
  TriangleMesh outside = make_corner(1.0f);
  for (std::uint32_t& index : outside.indices) index += 4;
  for (const TriangleMesh& hull : {points, line, far, none, outside}) {
    for (const glm::vec3& x : {glm::vec3(0.1f), glm::vec3(1.0f, 0.0f, 0.0f), glm::vec3(0.0f)}) {
      EXPECT_EQ(coordinates(hull, x), std::vector<float>(4, 0.25f));
    }
  }
}

TEST(MeanValueCoordinates, PointThatIsNoneWeighsAllTheSameAndDisturbsNoOther) {
  const TriangleMesh hull = make_corner(1.0f);
  const glm::vec3 good(0.1f, 0.2f, 0.3f);
  const std::vector<glm::vec3> points = {{kNone, 0, 0}, good, {0, kEndless, 0}, {0, 0, -kEndless}, good,
                                         glm::vec3(std::numeric_limits<float>::max())};
  const std::vector<float> rows = coordinates(hull, points);
  for (const std::size_t i : {0, 2, 3, 5}) {
    for (std::size_t v = 0; v < 4; ++v) EXPECT_EQ(rows[4 * i + v], 0.25f) << i;
  }
  for (const std::size_t i : {1, 4}) {
    expect_row(std::vector(rows.begin() + 4 * static_cast<std::ptrdiff_t>(i),
                           rows.begin() + 4 * static_cast<std::ptrdiff_t>(i) + 4), {0.4, 0.1, 0.2, 0.3});
  }
}

TEST(MeanValueCoordinates, TrianglesThatAreNoneAddNothing) {
  TriangleMesh hull = make_box(glm::vec3(-1.0f), glm::vec3(1.0f));
  const std::vector<glm::vec3> points = points_about(50, -1.5f, 1.5f, 1);
  const std::vector<float> plain = coordinates(hull, points);
  hull.indices.insert(hull.indices.end(), {0, 0, 1, 2, 3, 2, 5, 5, 5, 0, 1, 8, 7, 99, 3, 4000000000u, 1, 2});
  EXPECT_EQ(coordinates(hull, points), plain);
  hull.indices.push_back(3);  // two thirds of a triangle are missing
  EXPECT_EQ(coordinates(hull, points), plain);
}

TEST(MeanValueCoordinates, WhateverTheTrianglesWeightsAreFinite) {
  TriangleMesh open = make_box(glm::vec3(-1.0f), glm::vec3(1.0f));
  open.indices.resize(24);
  TriangleMesh sheet = make_corner(1.0f);  // two sides of one triangle, and a vertex off it that nothing uses
  sheet.indices = {0, 1, 2, 0, 2, 1};
  const std::vector<glm::vec3> points = points_about(200, -1.2f, 1.2f, 2);
  for (const TriangleMesh& hull : {open, sheet, make_soup(40, 3), make_soup(200, 4)}) {
    const std::vector<float> rows = coordinates(hull, points);
    const std::size_t count = hull.positions.size();
    for (std::size_t i = 0; i < points.size(); ++i) {
      double magnitude = 0.0;
      for (std::size_t v = 0; v < count; ++v) magnitude += std::abs(static_cast<double>(rows[i * count + v]));
      EXPECT_TRUE(std::isfinite(magnitude)) << i;
      EXPECT_NEAR(sum_of(std::span(rows).subspan(i * count, count)), 1.0, 1.0e-6 * magnitude) << i;
    }
  }
}

TEST(MeanValueCoordinates, OfAMeshWithHolesReproducePoints) {
  TriangleMesh hull = make_box(glm::vec3(-1.0f), glm::vec3(1.0f));
  hull.indices.resize(27);  // three quarters of it
  expect_precise(hull, points_about(200, -0.9f, 0.9f, 13), 2.0, 1.0e-6);
}

TEST(MeanValueCoordinates, OfASheetAreThoseOfAVertexOnItAndTheSameForAllBesideIt) {
  // A square, cut along one diagonal on its upper side and along the other on its lower side: no volume, and what a
  // point sees of the one side is what it sees of the other.
  TriangleMesh sheet;
  sheet.positions = {{-0.7f, -0.9f, 0.0f}, {1.1f, -0.6f, 0.0f}, {0.8f, 0.9f, 0.0f}, {-0.4f, 0.6f, 0.0f}};
  sheet.indices = {0, 1, 2, 0, 2, 3, 0, 3, 1, 1, 3, 2};
  for (const glm::vec3& x : points_about(50, 0.2f, 1.5f, 16)) {
    EXPECT_EQ(coordinates(sheet, x), std::vector<float>(4, 0.25f));
  }
  expect_row(coordinates(sheet, sheet.positions[1]), {0.0, 1.0, 0.0, 0.0});
}

// --- Known answers.

TEST(MeanValueCoordinates, OfATetrahedronAreBarycentric) {
  const TriangleMesh hull = make_corner(2.0f);
  // Inside, on faces, edges and vertices, in a face's plane, outside.
  const std::vector<glm::vec3> points = {
      {0.5f, 0.25f, 0.125f},   {0.01f, 1.5f, 0.2f},   {0.5f, 0.5f, 0.0f},  {0.0f, 1.0f, 0.25f}, {0.5f, 0.5f, 1.0f},
      {0.25f, 0.0f, 0.0f},     {0.0f, 1.5f, 0.5f},    {0.0f, 0.0f, 0.0f},  {0.0f, 2.0f, 0.0f},  {3.0f, 4.0f, 0.0f},
      {-0.5f, -0.25f, 0.125f}, {0.5f, 0.5f, -1e-6f},  {-1.0f, 0.0f, 0.0f}, {1.0f, 2.0f, 3.0f},  {0.5f, 1e-7f, 1e-9f}};
  for (const TriangleMesh& mesh : {hull, inside_out(hull)}) {
    for (const glm::vec3& p : points) {
      const glm::dvec3 b = 0.5 * glm::dvec3(p);
      const double most = 1.0 + std::abs(b.x) + std::abs(b.y) + std::abs(b.z);
      expect_row(coordinates(mesh, p), {1.0 - b.x - b.y - b.z, b.x, b.y, b.z}, 2.0e-7 * most);
    }
  }
}

TEST(MeanValueCoordinates, OfAnOctahedronsMiddleAreAllTheSame) {
  const TriangleMesh hull = make_sphere(1.0f, 2, 4, {0.5f, 0.25f, -2.0f});
  expect_row(coordinates(hull, glm::vec3(0.5f, 0.25f, -2.0f)), std::vector<double>(6, 1.0 / 6.0));
}

TEST(MeanValueCoordinates, OnTheHullAreThoseOfTheTriangle) {
  const TriangleMesh hull = make_box({0, 0, 0}, {2, 4, 1});
  // z = 1: triangles 4 5 6 and 5 7 6, with the diagonal from 5 to 6.
  expect_row(coordinates(hull, glm::vec3(0.5f, 1.0f, 1.0f)), {0, 0, 0, 0, 0.5, 0.25, 0.25, 0});
  expect_row(coordinates(hull, glm::vec3(1.5f, 3.0f, 1.0f)), {0, 0, 0, 0, 0, 0.25, 0.25, 0.5});
  expect_row(coordinates(hull, glm::vec3(1.5f, 1.0f, 1.0f)), {0, 0, 0, 0, 0, 0.75, 0.25, 0});
  expect_row(coordinates(hull, glm::vec3(0.5f, 0.0f, 1.0f)), {0, 0, 0, 0, 0.75, 0.25, 0, 0});
  expect_row(coordinates(hull, glm::vec3(2.0f, 4.0f, 1.0f)), {0, 0, 0, 0, 0, 0, 0, 1}, 0.0);
}

TEST(MeanValueCoordinates, AreWhatTheDefinitionIntegratesTo) {
  const TriangleMesh box = make_box({-1, -1, -1}, {1, 2, 1}), gutter = make_gutter();
  for (const glm::vec3& p : {glm::vec3(0.0f), glm::vec3(0.3f, 1.2f, -0.4f), glm::vec3(1.8f, 0.2f, 0.1f)}) {
    EXPECT_LT(largest_difference(coordinates(box, p), integrated_coordinates(box, p)), 2.0e-4);
  }
  // In a leg, in the planes of faces of the other leg, between the legs, and beside.
  for (const glm::vec3& p : {glm::vec3(0.5f, 2.2f, 0.6f), glm::vec3(1.5f, 0.5f, 0.5f), glm::vec3(1.5f, 2.0f, 0.5f),
                             glm::vec3(0.6f, 1.0f, 0.4f), glm::vec3(2.4f, 1.0f, 1.7f)}) {
    EXPECT_LT(largest_difference(coordinates(gutter, p), integrated_coordinates(gutter, p)), 5.0e-4);
    EXPECT_LT(largest_difference(coordinates(inside_out(gutter), p), integrated_coordinates(gutter, p)), 5.0e-4);
  }
  const TriangleMesh torus = make_torus(1.0f, 0.4f, 16, 9);
  for (const glm::vec3& p : {glm::vec3(0.9f, 0.1f, 0.05f), glm::vec3(0.0f, -1.1f, 0.1f), glm::vec3(0.0f)}) {
    EXPECT_LT(largest_difference(coordinates(torus, p), integrated_coordinates(torus, p, 40)), 5.0e-4);
  }
}

// --- Next to what is singular. The places are at the origin, where a float can come as close as it likes.

// Down to 1e-30 of it, on lines in many directions. Weights may change by `slope` a metre.
void expect_continuous(const TriangleMesh& hull, const std::vector<double>& limit, double slope) {
  std::vector<glm::vec3> points, directions = points_about(40, -1.0f, 1.0f, 5);
  for (const glm::vec3& axis : {glm::vec3(1, 0, 0), glm::vec3(0, 1, 0), glm::vec3(0, 0, 1), glm::vec3(1, 1, 0),
                                glm::vec3(1, 0, 1), glm::vec3(0, 1, -1), glm::vec3(1, 1e-6f, 0),
                                glm::vec3(1e-9f, 1, 0), glm::vec3(1, 1, 1e-12f)}) {
    directions.push_back(axis);
    directions.push_back(-axis);
  }
  for (const glm::vec3& direction : directions) {
    for (double h = 0.1; h > 1.0e-30; h *= 0.1) points.push_back(static_cast<float>(h) * direction);
  }
  const std::vector<float> rows = coordinates(hull, points);
  const std::size_t count = hull.positions.size();
  for (std::size_t i = 0; i < points.size(); ++i) {
    const std::span row(rows.data() + i * count, count);
    const double h = glm::length(points[i]);
    ASSERT_LE(largest_difference(row, limit), slope * h + 1.0e-7)
        << points[i].x << ' ' << points[i].y << ' ' << points[i].z;
    ASSERT_NEAR(sum_of(row), 1.0, 3.0e-7);
    ASSERT_LE(glm::distance(blend(row, hull.positions), glm::dvec3(points[i])), 1.0e-6);
  }
}

TEST(MeanValueCoordinates, AreContinuousAtAFace) {
  expect_continuous(make_box({-1, -1, 0}, {3, 1, 1}), {0.25, 0.25, 0.5, 0, 0, 0, 0, 0}, 8.0);
}
TEST(MeanValueCoordinates, AreContinuousAtAFlatEdge) {
  expect_continuous(make_box({-1, -1, 0}, {1, 1, 1}), {0, 0.5, 0.5, 0, 0, 0, 0, 0}, 8.0);
}
TEST(MeanValueCoordinates, AreContinuousAtASharpEdge) {
  expect_continuous(make_box({-1, 0, 0}, {3, 1, 1}), {0.75, 0.25, 0, 0, 0, 0, 0, 0}, 12.0);
}
TEST(MeanValueCoordinates, AreContinuousAtAVertex) {
  expect_continuous(make_box({0, 0, 0}, {1, 1, 1}), {1, 0, 0, 0, 0, 0, 0, 0}, 12.0);
}
TEST(MeanValueCoordinates, AreContinuousAtAConcaveEdge) {
  std::vector<double> limit(16, 0.0);
  limit[4] = limit[12] = 0.5;
  glm::mat4 motion(1.0f);
  motion[3] = glm::vec4(-2.0f, -1.0f, -0.5f, 1.0f);
  expect_continuous(moved(make_gutter(), motion), limit, 25.0);
}

TEST(MeanValueCoordinates, AreContinuousAtASkewEdge) {
  // Next to it, rounding decides the directions of everything that is short.
  Numbers numbers(14);
  for (int k = 0; k < 20; ++k) {
    const glm::mat4 turn = glm::rotate(glm::mat4(1.0f), 6.0f * numbers.next(), numbers.point(-1.0f, 1.0f));
    TriangleMesh hull = moved(make_box({-1, 0, 0}, {1, 1, 1}), turn);
    if (k % 2 == 1) hull = inside_out(hull);
    std::rotate(hull.indices.begin(), hull.indices.begin() + 3 * (k % 12), hull.indices.end());
    for (std::size_t i = 0; i < hull.indices.size(); i += 3) {
      const auto corner = hull.indices.begin() + static_cast<std::ptrdiff_t>(i);
      std::rotate(corner, corner + k % 3, corner + 3);
    }
    expect_continuous(hull, {0.5, 0.5, 0, 0, 0, 0, 0, 0}, 12.0);
  }
}

TEST(MeanValueCoordinates, AreSmoothInThePlaneOfAFarTriangle) {
  // Halfway they have changed by half, but for what is curved: what is left out there is no more than rounding.
  glm::mat4 motion(1.0f);
  motion[3] = glm::vec4(-0.5f, -1.0f, -0.25f, 1.0f);
  const TriangleMesh hull = moved(make_gutter(), motion);
  const std::vector<float> start = coordinates(hull, glm::vec3(0.0f));
  for (const glm::vec3& direction : points_about(20, -1.0f, 1.0f, 15)) {
    for (float h = 0.0625f; h > 1.0e-9f; h *= 0.5f) {
      const std::vector<float> end = coordinates(hull, h * direction), half = coordinates(hull, 0.5f * h * direction);
      for (std::size_t v = 0; v < start.size(); ++v) {
        ASSERT_NEAR(end[v] - half[v], half[v] - start[v], 4.0f * h * h + 2.0e-7f) << h;
      }
    }
  }
}

TEST(MeanValueCoordinates, AreContinuousInThePlaneOfAFarTriangle) {
  // In a leg at the height of the bottom's inner face, on its edges' lines, and outside in the planes of two faces.
  for (const glm::vec3& place :
       {glm::vec3(0.5f, 1.0f, 0.25f), glm::vec3(0.5f, 1.0f, 0.5f), glm::vec3(-1.0f, 3.0f, 0.5f),
        glm::vec3(5.0f, 3.0f, 1.0f), glm::vec3(1.5f, 2.0f, 1.0f), glm::vec3(-2.0f, 0.0f, 0.0f)}) {
    glm::mat4 motion(1.0f);
    motion[3] = glm::vec4(-place, 1.0f);
    const TriangleMesh hull = moved(make_gutter(), motion);
    const std::vector<float> there = coordinates(hull, glm::vec3(0.0f));
    expect_continuous(hull, std::vector<double>(there.begin(), there.end()), 8.0);
  }
}

// --- Sums.

TEST(MeanValueCoordinates, AreNegativeBesideConcavePartsAndStillSumUp) {
  const TriangleMesh gutter = make_gutter();
  const std::vector<float> row = coordinates(gutter, glm::vec3(0.5f, 2.9f, 0.5f));
  EXPECT_LT(*std::min_element(row.begin(), row.end()), -1.0e-3f);
  expect_precise(gutter, points_about(1000, 0.0f, 3.0f, 6), 3.0, 2.0e-7);
  expect_precise(make_torus(1.0f, 0.4f, 24, 12), points_about(1000, -1.0f, 1.0f, 7), 1.4, 2.0e-7);
}

TEST(MeanValueCoordinates, SumUpOutside) {
  const TriangleMesh hull = make_sphere(1.0f, 8, 12);
  expect_precise(hull, points_about(400, -3.0f, 3.0f, 8), 1.0, 1.0e-6);
  expect_precise(hull, points_about(100, 50.0f, 100.0f, 9), 100.0, 1.0e-4);
}

TEST(MeanValueCoordinates, SumUpWithSliversAndFlatTriangles) {
  // A sphere whose edges are cut into slivers: a vertex a hair off, or exactly on, each of some edges' middles, and on
  // one side only, so that what is left between is a triangle without a height.
  for (const float off : {0.0f, 1.0e-7f, 1.0e-5f, 1.0e-3f}) {
    TriangleMesh hull = make_box({-1, -1, -1}, {1, 1, 1});
    const std::vector<std::uint32_t> whole = hull.indices;
    hull.indices.clear();
    for (std::size_t i = 0; i < whole.size(); i += 3) {
      const std::uint32_t a = whole[i], b = whole[i + 1], c = whole[i + 2];
      const auto middle = static_cast<std::uint32_t>(hull.positions.size());
      const glm::vec3 &p = hull.positions[a], &q = hull.positions[b], &r = hull.positions[c];
      hull.positions.push_back(0.5f * (p + q) + off * (r - 0.5f * (p + q)));
      hull.indices.insert(hull.indices.end(), {a, b, middle, b, c, middle, c, a, middle});
    }
    std::vector<glm::vec3> points = points_about(1000, -1.0f, 1.0f, 10);
    points.insert(points.end(), hull.positions.begin(), hull.positions.end());
    for (std::size_t v = 8; v < hull.positions.size(); ++v) {
      points.push_back(0.5f * (hull.positions[v] + hull.positions[v - 1]));
      points.push_back(0.999f * hull.positions[v]);
    }
    expect_precise(hull, points, 2.0, 2.0e-7);
  }
}

TEST(MeanValueCoordinates, ReproduceAffineMotionsAtAnySizeAndPlace) {
  for (const float size : {1.0e-4f, 0.3f, 1.0e4f}) {
    Numbers numbers(11);
    const glm::vec3 centre = size * numbers.point(-3.0f, 3.0f);
    const TriangleMesh hull = make_sphere(size, 12, 20, centre);
    std::vector<glm::vec3> points;
    for (std::size_t i = 0; i < 300; ++i) points.push_back(centre + 0.55f * size * numbers.point(-1.0f, 1.0f));
    points.insert(points.end(), hull.positions.begin(), hull.positions.end());
    const std::vector<float> rows = coordinates(hull, points);
    EXPECT_LT(missed(rows, hull, points), 1.0e-6 * static_cast<double>(size));
    for (int k = 0; k < 5; ++k) {
      glm::dmat4 motion(1.0);
      for (int c = 0; c < 4; ++c) {
        const double scale = c == 3 ? static_cast<double>(size) : 1.0;
        motion[c] += scale * glm::dvec4(glm::dvec3(numbers.point(-1.0f, 1.0f)), 0.0);
      }
      EXPECT_LT(missed(rows, hull, points, motion), 3.0e-6 * static_cast<double>(size));
    }
  }
}

TEST(MeanValueCoordinates, AreTheSameForAnyNumberOfThreadsAndInAnyCompany) {
  const TriangleMesh hull = make_torus(1.0f, 0.4f, 16, 9);
  std::vector<glm::vec3> points = points_about(1001, -1.2f, 1.2f, 12);
  points[500] = hull.positions[7];
  std::vector<std::vector<float>> rows;
  for (const int threads : {1, 2, 5}) {
    parallel::WorkerArena arena(threads);
    arena.execute([&] { rows.push_back(coordinates(hull, points)); });
  }
  EXPECT_EQ(rows[0], rows[1]);
  EXPECT_EQ(rows[0], rows[2]);
  const std::size_t count = hull.positions.size();
  for (const std::size_t i : {0, 1, 2, 3, 499, 500, 501, 1000}) {
    const std::vector<float> alone = coordinates(hull, points[i]);
    EXPECT_TRUE(std::equal(alone.begin(), alone.end(), rows[0].begin() + static_cast<std::ptrdiff_t>(i * count))) << i;
  }
}

}  // namespace
}  // namespace fascicle::test
