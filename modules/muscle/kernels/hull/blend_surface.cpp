#include "modules/muscle/kernels/hull/blend_surface.hpp"

#include <algorithm>

#include <glm/mat4x4.hpp>
#include <glm/matrix.hpp>

#include "modules/muscle/kernels/hull/push_out.hpp"

namespace fascicle::muscle {
namespace {

double six_volumes(const SurfaceStep& step, std::span<SurfacePoint> points, SurfaceScratch& scratch) {
  return step.kernels->measure_volume({.triangles = step.asset->triangles, .vertex_count = step.asset->vertex_count,
                                       .points = points, .gradient = scratch.gradient, .rest = 0.0,
                                       .compliance = 0.0f, .rings = &step.asset->rings});
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
  place_bones(step, scratch.bones);
  push_out(step, scratch.bones, scratch.before, scratch.balls, scratch.near, touches);
  return six_volumes(step, step.points, scratch) / 6.0;
}

}  // namespace fascicle::muscle
