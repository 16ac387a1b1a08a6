#include "modules/muscle/kernels/surface/bone_contact.hpp"

#include <algorithm>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "modules/muscle/kernels/surface/way_into_bone.hpp"

namespace fascicle::muscle {
namespace {

glm::vec3 place(const SurfacePoint& p) { return {p.x, p.y, p.z}; }
glm::vec3 apply(const glm::mat4& m, const glm::vec3& p) { return glm::vec3(m * glm::vec4(p, 1.0f)); }

}  // namespace

VertexBall ball_about(std::span<const SurfacePoint> points) {
  glm::vec3 lower = place(points[0]), upper = lower;
  for (const SurfacePoint& p : points) {
    lower = glm::min(lower, place(p));
    upper = glm::max(upper, place(p));
  }
  return {0.5f * (lower + upper), 0.5f * glm::distance(lower, upper)};
}

std::size_t find_near_bone(const SurfaceBone& bone, std::span<const VertexBall> balls,
                           std::span<const SurfacePoint> points, float reach, std::span<std::uint32_t> near) {
  std::size_t count = 0;
  for (std::size_t ball = 0; ball < balls.size(); ++ball) {
    // Distances change by no more than one goes.
    if (bone.field->distance(apply(bone.to_bone, balls[ball].centre)) >= reach + balls[ball].radius) continue;
    const std::size_t first = ball * kBallVertices, end = std::min(points.size(), first + kBallVertices);
    for (std::size_t v = first; v < end; ++v) {
      if (!(points[v].inverse_mass > 0.0f)) continue;
      if (bone.field->distance(apply(bone.to_bone, place(points[v]))) < reach) {
        near[count++] = static_cast<std::uint32_t>(v);
      }
    }
  }
  return count;
}

void push_from_bone(const SurfaceBone& bone, std::span<const std::uint32_t> near, std::span<const SurfacePoint> before,
                    float distance, float friction, std::span<SurfacePoint> points, BoneTouch& touch) {
  touch.vertices = 0;
  for (const std::uint32_t v : near) {
    SurfacePoint& p = points[v];
    const glm::vec3 q = apply(bone.to_bone, place(p));
    const FieldValue value = bone.field->at(q);
    const float depth = distance - value.distance;
    if (!(depth > 0.0f)) continue;
    const glm::vec3 came_from = apply(bone.to_bone_before, place(before[v]));
    glm::vec3 out = q + depth * value.gradient;
    const bool deep = value.distance < -kShallow * bone.field->voxel() || value.gradient == glm::vec3(0.0f);
    if (deep && bone.field->distance(came_from) >= distance) out = way_in(*bone.field, came_from, q, distance);
    if (friction > 0.0f) {
      const glm::vec3 slid = out - came_from - glm::dot(out - came_from, value.gradient) * value.gradient;
      const float length = glm::length(slid);
      if (length > 0.0f) out -= slid * std::min(1.0f, friction * depth / length);
    }
    const glm::vec3 moved = apply(bone.from_bone, out);
    p.x = moved.x;
    p.y = moved.y;
    p.z = moved.z;
    ++touch.vertices;
    if (depth > touch.depth) {
      touch.depth = depth;
      touch.deepest = v;
    }
  }
}

}  // namespace fascicle::muscle
