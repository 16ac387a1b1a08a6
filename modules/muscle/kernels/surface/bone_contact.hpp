// Surface muscles against bones (4.2): vertices are kept `distance` away from the bones' surfaces by their level sets.
//
// Both of the method's cases are one here, because everything is seen from the bone: a vertex that has come into it,
// whoever moved, goes to the surface along the field's gradient; one that has come so deep that the gradient may lead to
// another side goes back along its way in the bone's frame to where it came in.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <glm/mat4x4.hpp>

#include "modules/muscle/asset/collision/bone_field.hpp"
#include "modules/muscle/asset/surface/surface_asset.hpp"

namespace fascicle::muscle {

// One bone during a step.
struct SurfaceBone {
  const BoneField* field = nullptr;
  glm::mat4 from_bone{1.0f}, to_bone{1.0f};  // the bone's frame -> simulation's frame, now, and back
  glm::mat4 to_bone_before{1.0f};            // at the substep's start
};

// What touched a bone in a step.
struct BoneTouch {
  std::uint32_t vertices = 0;  // pushed in the last substep
  float depth = 0.0f;          // m, beyond the contact distance: the most that one was pushed in the step
  std::uint32_t deepest = 0;   // that vertex
};

// A ball about vertices that follow each other, and so are near each other: the asset sorts them by place.
struct VertexBall {
  glm::vec3 centre{0.0f};
  float radius = 0.0f;  // m
};
inline constexpr std::size_t kBallVertices = 32;
VertexBall ball_about(std::span<const SurfacePoint> points);

// Vertices that may touch a bone during the coming step: those that can move and are nearer than `reach` (m) to its
// surface. `balls`: one for each kBallVertices of the points. `near` has room for all vertices. Returns how many.
std::size_t find_near_bone(const SurfaceBone& bone, std::span<const VertexBall> balls,
                           std::span<const SurfacePoint> points, float reach, std::span<std::uint32_t> near);

// Moves those that are nearer than `distance` (m) out. `before`: their places at the substep's start. `friction` is
// Coulomb's coefficient.
void push_from_bone(const SurfaceBone& bone, std::span<const std::uint32_t> near, std::span<const SurfacePoint> before,
                    float distance, float friction, std::span<SurfacePoint> points, BoneTouch& touch);

}  // namespace fascicle::muscle
