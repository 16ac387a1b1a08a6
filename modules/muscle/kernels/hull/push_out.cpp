#include "modules/muscle/kernels/hull/push_out.hpp"

#include <algorithm>

#include <glm/mat4x4.hpp>
#include <glm/matrix.hpp>

namespace fascicle::muscle {

void place_bones(const SurfaceStep& step, std::span<SurfaceBone> bones) {
  for (std::size_t b = 0; b < bones.size(); ++b) {
    bones[b].field = step.fields[b];
    if (bones[b].field == nullptr) continue;
    const glm::dmat4 now = glm::dmat4(step.rest_to_bone[b]) * glm::inverse(glm::dmat4(step.bones[b].to));
    bones[b].to_bone = bones[b].to_bone_before = glm::mat4(now);
    bones[b].from_bone = glm::mat4(glm::inverse(now));
  }
}

bool push_out(const SurfaceStep& step, std::span<const SurfaceBone> bones, std::span<const SurfacePoint> before,
              std::span<VertexBall> balls, std::span<std::uint32_t> near, std::span<BoneTouch> touches) {
  if (!step.settings.collide_with_bones) return false;
  const std::span<SurfacePoint> points = step.points.first(step.asset->vertex_count);
  balls = balls.first((points.size() + kBallVertices - 1) / kBallVertices);
  for (std::size_t i = 0; i < balls.size(); ++i) {
    const std::size_t first = i * kBallVertices;
    balls[i] = ball_about(points.subspan(first, std::min(kBallVertices, points.size() - first)));
  }
  const float distance = step.settings.contact_distance;
  bool any = false;
  for (std::size_t b = 0; b < bones.size(); ++b) {
    if (bones[b].field == nullptr) continue;
    const std::size_t count = find_near_bone(bones[b], balls, points, distance, near);
    const std::uint32_t touched = touches[b].vertices;
    push_from_bone(bones[b], near.first(count), before, distance, 0.0f, points, touches[b]);
    any = any || touches[b].vertices > 0;
    touches[b].vertices = std::max(touched, touches[b].vertices);
  }
  return any;
}

}  // namespace fascicle::muscle
