#include "modules/muscle/measure/points_inside.hpp"

#include <limits>

#include <gtest/gtest.h>

#include "tests/support/plain_surface.hpp"
#include "tests/support/shapes.hpp"

namespace fascicle::muscle {
namespace {

class PointsInside : public testing::Test {
 protected:
  PointsOutside measure(const std::vector<glm::vec3>& surface, const std::vector<glm::vec3>& points) {
    return meter_.measure(test::to_points(surface), test::to_points(points));
  }
  std::vector<glm::vec3> scaled(float by) const {
    std::vector<glm::vec3> places = mesh_.positions;
    for (glm::vec3& p : places) p *= by;
    return places;
  }

  TriangleMesh mesh_ = test::make_box({-0.01f, -0.02f, -0.03f}, {0.01f, 0.02f, 0.03f});
  InsideMeter meter_{std::make_shared<const SurfaceAsset>(test::plain_surface(mesh_))};
};

TEST_F(PointsInside, NoPointsAreNowhere) { EXPECT_EQ(measure(mesh_.positions, {}).count, 0u); }

TEST_F(PointsInside, WhatIsNotFiniteIsOutside) {
  const PointsOutside found = measure(mesh_.positions, {{0, 0, std::numeric_limits<float>::quiet_NaN()}, {0, 0, 0}});
  EXPECT_EQ(found.count, 1u);
  EXPECT_EQ(found.furthest, 0.0);
}

TEST_F(PointsInside, CountsThoseOutsideAndHowFar) {
  const PointsOutside found =
      measure(mesh_.positions, {{0, 0, 0}, {0.009f, 0.019f, 0.029f}, {0.012f, 0, 0}, {0, -0.025f, 0}, {0, 0, -0.029f}});
  EXPECT_EQ(found.count, 2u);
  EXPECT_NEAR(found.furthest, 0.005, 1e-8);
}

// The surface as it stands counts, not as it was.
TEST_F(PointsInside, FollowsTheSurface) {
  const std::vector<glm::vec3> point = {{0.012f, 0, 0}};
  EXPECT_EQ(measure(scaled(2.0f), point).count, 0u);
  EXPECT_EQ(measure(scaled(1.0f), point).count, 1u);
  EXPECT_NEAR(measure(scaled(0.5f), point).furthest, 0.007, 1e-8);
}

}  // namespace
}  // namespace fascicle::muscle
