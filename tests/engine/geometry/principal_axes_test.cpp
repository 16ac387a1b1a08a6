#include "engine/geometry/principal_axes.hpp"

#include <cmath>
#include <limits>

#include <glm/ext/matrix_transform.hpp>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "tests/support/shapes.hpp"

namespace fascicle {
namespace {

void expect_near(const glm::dvec3& a, const glm::dvec3& b, double tolerance) {
  EXPECT_NEAR(glm::distance(a, b), 0.0, tolerance) << a.x << " " << a.y << " " << a.z;
}

void expect_frame(const PrincipalAxes& found) {
  for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(glm::length(found.axes[i]), 1.0, 1e-9);
  expect_near(glm::cross(found.axes[0], found.axes[1]), found.axes[2], 1e-9);
}

TEST(PrincipalAxes, OfNothingAreTheCoordinateAxes) {
  const PrincipalAxes none = principal_axes({});
  expect_frame(none);
  EXPECT_EQ(none.ranges[0].x, 0.0);
  const PrincipalAxes point = principal_axes({"", {{1, 2, 3}}, {}, {0, 0, 0}});
  expect_frame(point);
  expect_near(point.centre, {1, 2, 3}, 1e-12);
  EXPECT_EQ(point.ranges[0].x, 0.0);
  EXPECT_EQ(point.deviations[0], 0.0);
}

TEST(PrincipalAxes, FiniteForAnything) {
  for (std::uint32_t seed = 0; seed < 30; ++seed) {
    TriangleMesh soup = test::make_soup(20, seed);
    soup.positions[seed % 5] = {std::numeric_limits<float>::quiet_NaN(), 0, 0};
    if (seed % 3 == 1) {
      for (glm::vec3& p : soup.positions) p *= 1e-15f;
    }
    if (seed % 3 == 2) {
      for (glm::vec3& p : soup.positions) p = {p.x, 0, 0.5f};  // all in one line
    }
    const PrincipalAxes found = principal_axes(soup);
    expect_frame(found);
    for (std::size_t i = 0; i < 3; ++i) {
      EXPECT_TRUE(std::isfinite(found.deviations[i]));
      EXPECT_TRUE(std::isfinite(found.ranges[i].x) && std::isfinite(found.ranges[i].y));
    }
  }
}

TEST(PrincipalAxes, OfABox) {
  const PrincipalAxes found = principal_axes(test::make_box({1, 1, 1}, {2, 5, 3}));
  expect_frame(found);
  expect_near(found.centre, {1.5, 3, 2}, 1e-6);
  expect_near(found.axes[0], {0, 1, 0}, 1e-9);
  expect_near(found.axes[1], {0, 0, 1}, 1e-9);
  EXPECT_NEAR(found.ranges[0].x, -2.0, 1e-6);
  EXPECT_NEAR(found.ranges[0].y, 2.0, 1e-6);
  EXPECT_NEAR(found.ranges[2].y, 0.5, 1e-6);
  EXPECT_GT(found.deviations[0], found.deviations[1]);
}

TEST(PrincipalAxes, DeviationOfASphere) {
  const PrincipalAxes found = principal_axes(test::make_sphere(2.0f, 80, 120));
  for (const double deviation : found.deviations) EXPECT_NEAR(deviation, 2.0 / std::sqrt(3.0), 3e-3);
}

TEST(PrincipalAxes, PointToTheThinEndWhereverItIs) {
  const TriangleMesh egg = [] {
    TriangleMesh mesh = test::make_sphere(1.0f, 20, 30);
    for (glm::vec3& p : mesh.positions) p = {p.x * (1.2f - 0.6f * p.z), 0.7f * p.y * (1.2f - 0.6f * p.z), 3.0f * p.z};
    return mesh;
  }();
  const PrincipalAxes plain = principal_axes(egg);
  expect_near(plain.axes[0], {0, 0, 1}, 1e-2);
  test::Numbers numbers(8);
  for (int i = 0; i < 20; ++i) {
    const glm::mat4 turn = glm::rotate(glm::translate(glm::mat4(1.0f), numbers.point(-1, 1)), 6.0f * numbers.next(),
                                       glm::normalize(numbers.point(-1, 1)));
    const PrincipalAxes turned = principal_axes(test::moved(egg, turn));
    expect_frame(turned);
    expect_near(turned.axes[0], glm::dmat3(glm::mat3(turn)) * plain.axes[0], 1e-5);
    EXPECT_NEAR(turned.ranges[0].y, plain.ranges[0].y, 1e-5);
  }
}

TEST(PrincipalAxes, OpenAndInvertedMeshesHaveThemToo) {
  TriangleMesh open = test::make_box({-1, -3, -2}, {1, 3, 2});
  open.indices.resize(30);
  EXPECT_GT(std::abs(principal_axes(open).axes[0].y), 0.9);
  EXPECT_GT(std::abs(principal_axes(test::inside_out(open)).axes[0].y), 0.9);
}

}  // namespace
}  // namespace fascicle
