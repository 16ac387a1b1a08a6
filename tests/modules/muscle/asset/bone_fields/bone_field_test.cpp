// Fields of shapes whose distances are known.
#include "modules/muscle/asset/collision/bone_field.hpp"

#include <bit>
#include <cmath>
#include <limits>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "modules/muscle/asset/bone_fields/bone_grid.hpp"
#include "tests/modules/muscle/asset/bone_fields/field_points.hpp"
#include "tests/support/shapes.hpp"

namespace fascicle::muscle {
namespace {

constexpr float kRadius = 0.020f;
const glm::vec3 kCentre(0.1f, -0.05f, 0.013f);

BoneField make_field(const TriangleMesh& mesh, float voxel = 0.002f) {
  auto field = build_bone_field({&mesh, 1}, "bone", {.voxel = voxel});
  EXPECT_TRUE(field.ok()) << to_text(field.diagnostics());
  return field ? **field : BoneField();
}

BoneField sphere_field(float voxel = 0.002f) {
  return make_field(test::make_sphere(kRadius, 64, 128, kCentre), voxel);
}

double box_distance(const glm::vec3& point, const glm::vec3& half) {
  const glm::vec3 q = glm::abs(point) - half;
  return glm::length(glm::max(q, glm::vec3(0.0f))) + std::min(std::max({q.x, q.y, q.z}), 0.0f);
}

TEST(BoneField, NoBoneIsNowhere) {
  const BoneField none;
  EXPECT_EQ(none.distance({0, 0, 0}), kNowhere);
  EXPECT_EQ(none.at({1, 2, 3}).gradient, glm::vec3(0.0f));
}

TEST(BoneField, PointsThatAreNotFiniteAreFarAwayAndNoWayLeadsOut) {
  const BoneField field = sphere_field();
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN(), kInf = std::numeric_limits<float>::infinity();
  for (const float bad : {kNan, kInf, -kInf}) {
    for (int axis = 0; axis < 3; ++axis) {
      glm::vec3 point = kCentre;
      point[axis] = bad;
      EXPECT_EQ(field.distance(point), kNowhere);
      EXPECT_EQ(field.at(point).distance, kNowhere);
      EXPECT_EQ(field.at(point).gradient, glm::vec3(0.0f));
    }
  }
  for (const float large : {1e10f, -1e20f, 3e38f}) {
    const FieldValue value = field.at({large, large, 0.0f});
    EXPECT_EQ(value.distance, kNowhere);
    EXPECT_NEAR(glm::length(value.gradient), 1.0f, 1e-5f);
  }
}

TEST(BoneField, ASphereNearItsSurfaceWithinAQuarterOfASquaredVoxelByItsRadius) {
  for (const float voxel : {0.004f, 0.002f, 0.001f}) {
    const BoneField field = sphere_field(voxel);
    double worst = 0.0, worst_angle = 0.0;
    for (const glm::vec3& point : test::points_in_box(kCentre - 0.03f, kCentre + 0.03f, 20'000)) {
      const glm::vec3 out = point - kCentre;
      const double wanted = glm::length(out) - kRadius;
      if (std::abs(wanted) > 0.005) continue;
      const FieldValue value = field.at(point);
      worst = std::max(worst, std::abs(value.distance - wanted));
      worst_angle = std::max(worst_angle, double{glm::length(value.gradient - glm::normalize(out))});
      EXPECT_NEAR(glm::length(value.gradient), 1.0f, 1e-5f);
    }
    // Interpolating 1 / r'' leaves h^2 / 4r at most; the mesh itself lies up to 12 um inside the sphere.
    EXPECT_LT(worst, voxel * voxel / (4.0f * 0.015f) + 12e-6);
    EXPECT_GT(worst, 0.0);
    EXPECT_LT(worst_angle, voxel / 0.015f);
  }
}

TEST(BoneField, ABoxInsideAndOut) {
  const glm::vec3 half(0.030f, 0.020f, 0.025f);
  const float voxel = 0.002f;
  const BoneField field = make_field(test::make_box(-half, half), voxel);
  EXPECT_EQ(field.lower(), -half);
  EXPECT_EQ(field.upper(), half);
  EXPECT_FLOAT_EQ(field.band(), 0.010f);
  for (const glm::vec3& point : test::points_in_box(-half - 0.009f, half + 0.009f, 20'000)) {
    const double wanted = box_distance(point, half);
    if (wanted > field.band()) continue;
    // Across edges and the box's middle planes the distance has kinks.
    EXPECT_NEAR(field.distance(point), wanted, 0.87 * voxel);
  }
  // Off the kinks the distance is linear, and so is what is interpolated.
  EXPECT_NEAR(field.distance({0.0301f, 0.001f, 0.002f}), 0.0001f, 1e-6f);
  const FieldValue below = field.at({0.001f, -0.0153f, 0.0f});
  EXPECT_NEAR(below.distance, -0.0047f, 1e-6f);
  EXPECT_NEAR(below.gradient.y, -1.0f, 1e-4f);
}

TEST(BoneField, InsideEveryGradientPointsOut) {
  const BoneField field = sphere_field();
  int asked = 0;
  for (const glm::vec3& point : test::points_in_box(kCentre - kRadius, kCentre + kRadius, 5'000)) {
    const glm::vec3 out = point - kCentre;
    const float radius = glm::length(out);
    if (radius > kRadius || radius < 2.0f * field.voxel()) continue;
    const FieldValue value = field.at(point);
    EXPECT_NEAR(value.distance, radius - kRadius, 0.25f * field.voxel());
    EXPECT_GT(glm::dot(value.gradient, out / radius), 0.9f);
    ++asked;
  }
  EXPECT_GT(asked, 2'000);
  EXPECT_LT(field.distance(kCentre), -kRadius + field.voxel());
}

TEST(BoneField, BeyondTheBandTheAnswerIsNeverMoreThanTheDistance) {
  const BoneField field = sphere_field();
  int far = 0;
  for (const glm::vec3& point : test::points_in_box(kCentre - 0.2f, kCentre + 0.2f, 50'000)) {
    const double distance = glm::length(point - kCentre) - kRadius;
    const FieldValue value = field.at(point);
    EXPECT_EQ(value.distance, field.distance(point));
    if (distance < field.band() + field.voxel()) continue;
    ++far;
    EXPECT_LE(value.distance, distance + 13e-6);  // the mesh is no perfect sphere
    EXPECT_GE(value.distance, field.band());
    EXPECT_GE(value.distance, distance - 2.0 * std::sqrt(3.0) * 7.0 * field.voxel());  // and of use: two bricks short
    EXPECT_GT(glm::dot(value.gradient, point - kCentre), 0.0f);
  }
  EXPECT_GT(far, 40'000);
}

TEST(BoneField, ManyAtOnceAreTheSameBitForBit) {
  const BoneField field = sphere_field();
  std::vector<float> x, y, z;
  for (const glm::vec3& point : test::points_in_box(kCentre - 0.06f, kCentre + 0.06f, 20'001)) {
    x.push_back(point.x);
    y.push_back(point.y);
    z.push_back(point.z);
  }
  x[17] = std::numeric_limits<float>::quiet_NaN();
  y[18] = std::numeric_limits<float>::infinity();
  std::vector<float> distances(x.size());
  field.distances(x, y, z, distances);
  for (std::size_t i = 0; i < x.size(); ++i) {
    const float one = field.distance({x[i], y[i], z[i]});
    ASSERT_EQ(std::bit_cast<std::uint32_t>(distances[i]), std::bit_cast<std::uint32_t>(one)) << i;
  }
}

TEST(BoneField, CellsMeet) {
  const BoneField field = sphere_field();
  // Along a line across many bricks the distance never changes faster than the way.
  float before = field.distance(kCentre + glm::vec3(-0.04f, 0.0031f, 0.0017f));
  for (int i = 1; i <= 80'000; ++i) {
    const float here = field.distance(kCentre + glm::vec3(-0.04f + 1e-6f * static_cast<float>(i), 0.0031f, 0.0017f));
    if (before < field.band() && here < field.band()) {
      ASSERT_LT(std::abs(here - before), 2e-6f) << i;
    }
    before = here;
  }
}

}  // namespace
}  // namespace fascicle::muscle
