// A spindle-shaped muscle along z with its ends on bones 0 (lower, the frame) and 1 (upper), and its coarse hull: small
// enough to be posed a hundred times, with answers that are known.
#pragma once

#include <memory>
#include <vector>

#include <gtest/gtest.h>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include "modules/muscle/asset/hull/hull_asset.hpp"
#include "modules/muscle/asset/hull/progressive_hull.hpp"
#include "modules/muscle/kernels/hull/pose_surface.hpp"
#include "tests/support/shapes.hpp"

namespace fascicle::muscle {

inline constexpr float kSpindleLength = 0.2f, kSpindleRadius = 0.03f;

struct PosedSpindle {
  SurfaceMuscleDescription description;
  std::shared_ptr<const SurfaceAsset> asset;
  std::shared_ptr<const HullAsset> hull;
  AlignedVector<SurfacePoint> points, velocity;
  std::vector<RigidMotion> attachments{2}, carriers, bones;
  std::vector<const BoneField*> fields;
  std::vector<glm::mat4> rest_to_bone;
  std::vector<glm::vec3> line;
  HullSettings settings;
  HullScratch scratch;
  SimdLevel simd = detect_simd();

  // `field`: of a third bone, which stands still; null: none.
  explicit PosedSpindle(const BoneField* field = nullptr, std::uint32_t hull_vertices = 60, float direction = 1.0f) {
    description.name = "spindle";
    description.mesh = test::make_sphere(1.0f, 24, 20);
    SurfaceAttachment lower{.bone = 0, .origin = true, .vertices = {}}, upper{.bone = 1, .origin = false, .vertices = {}};
    for (std::uint32_t v = 0; v < description.mesh.positions.size(); ++v) {
      glm::vec3& p = description.mesh.positions[v];
      if (p.z < -0.8f) lower.vertices.push_back(v);
      if (p.z > 0.8f) upper.vertices.push_back(v);
      p *= glm::vec3(kSpindleRadius, kSpindleRadius, 0.5f * kSpindleLength);
    }
    description.attachments = {lower, upper};
    description.action_line = {{0, {0.0f, 0.0f, -0.5f * kSpindleLength}}, {1, {0.0f, 0.0f, 0.5f * kSpindleLength}}};
    description.levels = {{.solver = SurfaceSolver::kCoarseHull}};
    description.hull.vertices = hull_vertices;
    description.hull.direction = direction;
    if (field != nullptr) {
      description.bones = {2};
      fields = {field};
      rest_to_bone = {glm::mat4(1.0f)};
      bones = {{}};
    }
    const auto built = build_surface_asset(description, 3);
    EXPECT_TRUE(built.ok()) << to_text(built.diagnostics());
    asset = *built;
    const auto coarse = build_progressive_hull(description.mesh, {.vertices = hull_vertices});
    EXPECT_TRUE(coarse.ok()) << to_text(coarse.diagnostics());
    const auto reduced = build_hull_asset(*asset, description, coarse->mesh);
    EXPECT_TRUE(reduced.ok()) << to_text(reduced.diagnostics());
    hull = *reduced;
    settings = hull->settings;
    points = asset->rest;
    velocity.assign(points.size(), SurfacePoint{});
    carriers.resize(asset->carriers.size());
    lay_out(*asset, *hull, scratch);
    move();
  }

  // Both bones' motions since rest.
  void move(const glm::mat4& lower, const glm::mat4& upper) {
    const glm::mat4 of_bone[2] = {lower, upper};
    for (std::size_t i = 0; i < 2; ++i) attachments[i].to = of_bone[i];
    for (std::size_t c = 0; c < carriers.size(); ++c) {
      carriers[c].to = of_bone[asset->carriers[c].bone];
    }
    line.clear();
    for (const HullLinePoint& point : hull->line) line.emplace_back(of_bone[point.bone] * glm::vec4(point.rest, 1.0f));
  }
  void move() { move(glm::mat4(1.0f), glm::mat4(1.0f)); }

  SurfaceStep step() {
    return {.asset = asset.get(), .kernels = &surface_kernels(simd), .settings = asset->settings, .step = 1.0f / 60.0f,
            .attachments = attachments, .carriers = carriers, .bones = bones, .fields = fields,
            .rest_to_bone = rest_to_bone, .points = points, .velocity = velocity};
  }
  HullPose pose() { return pose_surface(step(), *hull, hull_kernels(simd), settings, line, scratch); }

  glm::vec3 point(std::uint32_t v) const { return {points[v].x, points[v].y, points[v].z}; }
  glm::vec3 rest(std::uint32_t v) const { return {asset->rest[v].x, asset->rest[v].y, asset->rest[v].z}; }
};

// The upper bone bent by `angle` (rad) about x at the spindle's middle.
inline glm::mat4 bent(float angle) { return glm::rotate(glm::mat4(1.0f), angle, glm::vec3(1.0f, 0.0f, 0.0f)); }

}  // namespace fascicle::muscle
