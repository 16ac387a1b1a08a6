#include "modules/muscle/kernels/hull/mesh_volume.hpp"

#include <vector>

#include <gtest/gtest.h>
#include <glm/gtc/matrix_transform.hpp>

#include "tests/support/shapes.hpp"

namespace fascicle::muscle {
namespace {

std::vector<SurfacePoint> points_of(const TriangleMesh& mesh) {
  std::vector<SurfacePoint> points;
  for (const glm::vec3& p : mesh.positions) points.push_back({p.x, p.y, p.z, 1.0f});
  return points;
}

TEST(MeshVolume, NoPointsHaveNone) { EXPECT_EQ(measure_volume({}, {}, {}), 0.0); }

TEST(MeshVolume, IsThatOfABoxWhereverItStandsAndNegativeInsideOut) {
  for (const glm::vec3 at : {glm::vec3(0.0f), glm::vec3(100.0f, -50.0f, 3.0f)}) {
    const TriangleMesh box = test::make_box(at, at + glm::vec3(0.25f, 0.5f, 0.125f));
    EXPECT_NEAR(measure_volume(box.indices, points_of(box), {}), 0.015625, 1e-7);
    const TriangleMesh inside = test::inside_out(box);
    EXPECT_NEAR(measure_volume(inside.indices, points_of(inside), {}), -0.015625, 1e-7);
  }
}

TEST(MeshVolume, TheGradientIsThatOfFiniteDifferences) {
  const TriangleMesh ball = test::make_sphere(0.5f, 8, 10);
  std::vector<SurfacePoint> points = points_of(ball), gradient(points.size());
  measure_volume(ball.indices, points, gradient);
  constexpr float kStep = 1.0f / 128.0f;
  for (std::size_t v = 0; v < points.size(); v += 7) {
    float* place[] = {&points[v].x, &points[v].y, &points[v].z};
    const float expected[] = {gradient[v].x, gradient[v].y, gradient[v].z};
    for (int axis = 0; axis < 3; ++axis) {
      const float before = *place[axis];
      *place[axis] = before + kStep;
      const double more = measure_volume(ball.indices, points, {});
      *place[axis] = before - kStep;
      const double less = measure_volume(ball.indices, points, {});
      *place[axis] = before;
      // The volume is linear in each single coordinate.
      EXPECT_NEAR((more - less) / (2.0 * static_cast<double>(kStep)), static_cast<double>(expected[axis]), 1e-4);
    }
  }
}

TEST(MeshVolume, WhatTheGradientHeldBeforeIsForgotten) {
  const TriangleMesh ball = test::make_sphere(0.5f, 6, 6);
  std::vector<SurfacePoint> once(ball.positions.size()), twice(ball.positions.size(), {9.0f, 9.0f, 9.0f, 9.0f});
  measure_volume(ball.indices, points_of(ball), once);
  measure_volume(ball.indices, points_of(ball), twice);
  for (std::size_t v = 0; v < once.size(); ++v) EXPECT_EQ(once[v].x, twice[v].x);
}

}  // namespace
}  // namespace fascicle::muscle
