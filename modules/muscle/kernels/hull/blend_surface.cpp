#include "modules/muscle/kernels/hull/blend_surface.hpp"

#include <algorithm>

#include <glm/mat4x4.hpp>
#include <glm/matrix.hpp>

namespace fascicle::muscle {
namespace {

double six_volumes(const SurfaceStep& step, std::span<SurfacePoint> points, SurfaceScratch& scratch) {
  return step.kernels->measure_volume({.triangles = step.asset->triangles, .vertex_count = step.asset->vertex_count,
                                       .points = points, .gradient = scratch.gradient, .rest = 0.0,
                                       .compliance = 0.0f, .rings = &step.asset->rings});
}

// What is too near to a bone goes out of it. `scratch.before` holds places that are known to be outside: a vertex that
// is deep goes back towards its own.
void push_out(const SurfaceStep& step, SurfaceScratch& scratch, std::span<BoneTouch> touches) {
  if (!step.settings.collide_with_bones) return;
  const std::span<SurfacePoint> vertices = step.points.first(step.asset->vertex_count);
  for (std::size_t i = 0; i < scratch.balls.size(); ++i) {
    const std::size_t first = i * kBallVertices;
    scratch.balls[i] = ball_about(vertices.subspan(first, std::min(kBallVertices, vertices.size() - first)));
  }
  for (std::size_t b = 0; b < step.bones.size(); ++b) {
    if (step.fields[b] == nullptr) continue;
    const glm::dmat4 to_bone = glm::dmat4(step.rest_to_bone[b]) * glm::inverse(glm::dmat4(step.bones[b].to));
    const SurfaceBone bone{.field = step.fields[b], .from_bone = glm::mat4(glm::inverse(to_bone)),
                           .to_bone = glm::mat4(to_bone), .to_bone_before = glm::mat4(to_bone)};
    const float distance = step.settings.contact_distance;
    const std::size_t count = find_near_bone(bone, scratch.balls, vertices, distance, scratch.near);
    BoneTouch touch;
    push_from_bone(bone, std::span(scratch.near).first(count), scratch.before, distance, 0.0f, vertices, touch);
    touches[b].vertices = std::max(touches[b].vertices, touch.vertices);
    if (touch.depth <= touches[b].depth) continue;
    touches[b].depth = touch.depth;
    touches[b].deepest = touch.deepest;
  }
}

}  // namespace

void carry_along(const SurfaceStep& step, SurfaceScratch& scratch, std::span<SurfacePoint> places) {
  for (std::size_t c = 0; c < step.carriers.size(); ++c) {
    const RigidMotion& motion = step.carriers[c];
    const glm::dmat4 moved = motion.from == motion.to
                                 ? glm::dmat4(0.0)
                                 : glm::dmat4(motion.to) * glm::inverse(glm::dmat4(motion.from)) - glm::dmat4(1.0);
    for (int row = 0; row < 3; ++row) {
      for (int column = 0; column < 4; ++column) {
        scratch.moved[12 * c + static_cast<std::size_t>(4 * row + column)] = static_cast<float>(moved[column][row]);
      }
    }
  }
  step.kernels->carry({.carry = step.asset->carry, .moved = scratch.moved, .vertex_count = step.asset->vertex_count,
                       .rest = step.points, .out = places});
}

double take_difference(const SurfaceStep& step, SurfaceScratch& scratch, std::span<SurfacePoint> places) {
  const double volumes = six_volumes(step, places, scratch) - six_volumes(step, step.points, scratch);
  for (std::uint32_t v = 0; v < step.asset->vertex_count; ++v) {
    const SurfacePoint& p = step.points[v];
    SurfacePoint& d = places[v];
    d = p.inverse_mass > 0.0f ? SurfacePoint{d.x - p.x, d.y - p.y, d.z - p.z, 0.0f} : SurfacePoint{};
  }
  return volumes / 6.0;
}

float fading(float part) {
  if (!(part > 0.0f)) return 0.0f;
  const float p = std::min(part, 1.0f);
  return p * p * (3.0f - 2.0f * p);
}

double add_difference(const SurfaceStep& step, float share, std::span<const SurfacePoint> difference,
                      double volume_difference, SurfaceScratch& scratch, std::span<BoneTouch> touches) {
  const double wanted = six_volumes(step, step.points, scratch) + 6.0 * static_cast<double>(share) * volume_difference;
  for (std::uint32_t v = 0; v < step.asset->vertex_count; ++v) {
    SurfacePoint& p = step.points[v];
    scratch.before[v] = p;
    p.x += share * difference[v].x;
    p.y += share * difference[v].y;
    p.z += share * difference[v].z;
  }
  step.kernels->project_volume({.triangles = step.asset->triangles, .vertex_count = step.asset->vertex_count,
                                .points = step.points, .gradient = scratch.gradient, .rest = wanted,
                                .compliance = 0.0f, .rings = &step.asset->rings});
  push_out(step, scratch, touches);
  return six_volumes(step, step.points, scratch) / 6.0;
}

}  // namespace fascicle::muscle
