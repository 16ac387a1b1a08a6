// The fade from one solver's shape to another's: it begins and ends where it should, keeps the volume and stays out of
// bones.
#include "modules/muscle/kernels/hull/blend_surface.hpp"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include "tests/support/analytic_bones.hpp"
#include "tests/support/shapes.hpp"

namespace fascicle::muscle {
namespace {

constexpr float kRadius = 0.05f;

// A ball whose vertices furthest back are held by bone 1, which carries the others, too.
struct Ball {
  std::shared_ptr<const SurfaceAsset> asset;
  AlignedVector<SurfacePoint> points, velocity, difference;
  std::vector<RigidMotion> attachments{{}}, carriers, bones;
  std::vector<const BoneField*> fields;
  std::vector<glm::mat4> rest_to_bone;
  std::vector<BoneTouch> touches;
  SurfaceScratch scratch;

  explicit Ball(const BoneField* field = nullptr) {
    SurfaceMuscleDescription description;
    description.name = "ball";
    description.mesh = test::make_sphere(kRadius, 16, 24);
    SurfaceAttachment held{.bone = 1, .origin = true, .vertices = {}};
    for (std::uint32_t v = 0; v < description.mesh.positions.size(); ++v) {
      if (description.mesh.positions[v].y < -0.04f) held.vertices.push_back(v);
    }
    description.attachments = {held};
    if (field != nullptr) {
      description.bones = {0};
      fields = {field};
      rest_to_bone = {glm::mat4(1.0f)};
      bones = {{}};
      touches.resize(1);
    }
    const auto built = build_surface_asset(description, 2);
    EXPECT_TRUE(built.ok()) << to_text(built.diagnostics());
    asset = *built;
    points = asset->rest;
    velocity.assign(asset->rest.size(), SurfacePoint{});
    difference.assign(asset->vertex_count, SurfacePoint{});
    carriers.assign(asset->carriers.size(), RigidMotion{});
    lay_out(*asset, scratch);
  }
  SurfaceStep step() {
    return {.asset = asset.get(), .kernels = &surface_kernels(detect_simd()), .settings = asset->settings,
            .step = 1.0f / 60.0f, .attachments = attachments, .carriers = carriers, .bones = bones, .fields = fields,
            .rest_to_bone = rest_to_bone, .points = points, .velocity = velocity};
  }
  glm::vec3 point(std::uint32_t v) const { return {points[v].x, points[v].y, points[v].z}; }
  glm::vec3 rest(std::uint32_t v) const { return {asset->rest[v].x, asset->rest[v].y, asset->rest[v].z}; }
  void set(AlignedVector<SurfacePoint>& to, std::uint32_t v, const glm::vec3& p) const {
    to[v].x = p.x;
    to[v].y = p.y;
    to[v].z = p.z;
  }
  // An ellipsoid of the same volume, in place of the ball.
  glm::vec3 squeezed(std::uint32_t v) const { return rest(v) * glm::vec3(1.0f / 1.21f, 1.1f, 1.1f); }
};

TEST(Fading, BeginsAndEndsSlowlyAndTakesAnyNumber) {
  EXPECT_EQ(fading(0.0f), 0.0f);
  EXPECT_EQ(fading(1.0f), 1.0f);
  EXPECT_EQ(fading(-2.0f), 0.0f);
  EXPECT_EQ(fading(7.0f), 1.0f);
  EXPECT_EQ(fading(std::numeric_limits<float>::quiet_NaN()), 0.0f);
  EXPECT_EQ(fading(std::numeric_limits<float>::infinity()), 1.0f);
  EXPECT_NEAR(fading(0.5f), 0.5f, 1e-6f);
  EXPECT_LT(fading(0.01f), 0.0004f);
  EXPECT_GT(fading(0.99f), 0.9996f);
  float before = 0.0f;
  for (int i = 1; i <= 1000; ++i) {
    const float now = fading(0.001f * static_cast<float>(i));
    EXPECT_GE(now, before);
    EXPECT_LE(now - before, 0.00151f);
    before = now;
  }
}

TEST(CarryAlong, GoesWithTheCarriersAlone) {
  Ball ball;
  for (std::uint32_t v = 0; v < ball.asset->vertex_count; ++v) ball.set(ball.points, v, ball.squeezed(v));
  carry_along(ball.step(), ball.scratch, ball.difference);
  for (std::uint32_t v = 0; v < ball.asset->vertex_count; ++v) EXPECT_EQ(ball.difference[v].y, ball.points[v].y);
  ASSERT_FALSE(ball.carriers.empty());
  const glm::mat4 from = glm::translate(glm::mat4(1.0f), {0.3f, 0.0f, 0.0f});
  const glm::mat4 to = glm::rotate(glm::translate(glm::mat4(1.0f), {0.0f, 0.2f, 0.1f}), 0.7f, glm::vec3(0, 0, 1));
  for (RigidMotion& motion : ball.carriers) motion = {from, to};
  carry_along(ball.step(), ball.scratch, ball.difference);
  for (std::uint32_t v = 0; v < ball.asset->vertex_count; ++v) {
    const glm::vec3 want(to * glm::inverse(from) * glm::vec4(ball.point(v), 1.0f));
    EXPECT_LT(glm::distance({ball.difference[v].x, ball.difference[v].y, ball.difference[v].z}, want), 1e-6f);
  }
}

TEST(TakeDifference, ThatOfAttachedVerticesIsNothing) {
  Ball ball;
  for (std::uint32_t v = 0; v < ball.asset->vertex_count; ++v) {
    ball.set(ball.difference, v, ball.rest(v) + glm::vec3(0.0f, 0.01f, 0.0f));
  }
  const double volume = take_difference(ball.step(), ball.scratch, ball.difference);
  EXPECT_NEAR(volume / ball.asset->volume, 0.0, 1e-5);
  std::size_t held = 0;
  for (std::uint32_t v = 0; v < ball.asset->vertex_count; ++v) {
    const bool free = ball.points[v].inverse_mass > 0.0f;
    held += free ? 0 : 1;
    EXPECT_NEAR(ball.difference[v].y, free ? 0.01f : 0.0f, 1e-7f);
    EXPECT_EQ(ball.difference[v].x, 0.0f);
  }
  EXPECT_EQ(held, ball.asset->attached.size());
  EXPECT_GT(held, 0u);
}

// Two ellipsoids of one volume: what lies between them is 1 % too large or more, and the fade has it right.
TEST(AddDifference, KeepsTheVolumeBetweenTheTwo) {
  Ball ball;
  for (std::uint32_t v = 0; v < ball.asset->vertex_count; ++v) {
    const glm::vec3 p = ball.rest(v);
    ball.set(ball.points, v, ball.squeezed(v));
    ball.set(ball.difference, v, p * glm::vec3(1.21f, 1.0f / 1.1f, 1.0f / 1.1f));
  }
  const AlignedVector<SurfacePoint> pose = ball.points;
  const double change = take_difference(ball.step(), ball.scratch, ball.difference);
  double plain = 0.0;
  for (const float share : {1.0f, 0.75f, 0.5f, 0.25f, 1e-6f}) {
    ball.points = pose;
    const double volume = add_difference(ball.step(), share, ball.difference, change, ball.scratch, ball.touches);
    EXPECT_NEAR(volume / ball.asset->volume, 1.0, 0.02) << share;  // held vertices make it a little less at one end
    for (const AttachedVertex& held : ball.asset->attached) {
      EXPECT_EQ(ball.points[held.vertex].x, pose[held.vertex].x);
    }
    if (share < 1e-5f) {
      for (std::uint32_t v = 0; v < ball.asset->vertex_count; ++v) {
        EXPECT_NEAR(ball.points[v].x, pose[v].x, 1e-6f);
        EXPECT_NEAR(ball.points[v].y, pose[v].y, 1e-6f);
      }
    }
    if (share != 0.5f) continue;
    AlignedVector<SurfacePoint> mixed = pose;
    for (std::uint32_t v = 0; v < ball.asset->vertex_count; ++v) {
      mixed[v].x += share * ball.difference[v].x;
      mixed[v].y += share * ball.difference[v].y;
      mixed[v].z += share * ball.difference[v].z;
    }
    plain = ball.step().kernels->measure_volume({.triangles = ball.asset->triangles,
                                                 .vertex_count = ball.asset->vertex_count, .points = mixed,
                                                 .gradient = ball.scratch.gradient, .rest = 0.0, .compliance = 0.0f,
                                                 .rings = &ball.asset->rings}) / 6.0;
    EXPECT_GT(std::abs(plain - ball.asset->volume), 3.0 * std::abs(volume - ball.asset->volume));
  }
}

TEST(AddDifference, StaysOutOfBones) {
  const auto floor = test::box_bone({-0.1f, -0.1f, -0.12f}, {0.1f, 0.1f, -0.052f}, 0.002f);
  for (const float down : {0.004f, 0.02f}) {  // shallow, and deeper than gradients lead
    Ball ball(floor.get());
    for (std::uint32_t v = 0; v < ball.asset->vertex_count; ++v) {
      if (ball.points[v].inverse_mass > 0.0f) ball.difference[v] = {0.0f, 0.0f, -down, 0.0f};
    }
    add_difference(ball.step(), 1.0f, ball.difference, 0.0, ball.scratch, ball.touches);
    const float keep = -0.052f + ball.asset->settings.contact_distance;
    for (std::uint32_t v = 0; v < ball.asset->vertex_count; ++v) EXPECT_GT(ball.points[v].z, keep - 2e-4f) << v;
    EXPECT_GT(ball.touches[0].vertices, 5u);
    EXPECT_GT(ball.touches[0].depth, 0.5f * down);
  }
  // Not where a game has switched that off.
  Ball ball(floor.get());
  for (SurfacePoint& d : ball.difference) d.z = -0.004f;
  SurfaceStep step = ball.step();
  step.settings.collide_with_bones = false;
  add_difference(step, 1.0f, ball.difference, 0.0, ball.scratch, ball.touches);
  EXPECT_EQ(ball.touches[0].vertices, 0u);
}

}  // namespace
}  // namespace fascicle::muscle
