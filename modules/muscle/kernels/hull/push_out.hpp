// Static intersection (4.5): whole meshes against bones, where the step ends.
#pragma once

#include <cstdint>
#include <span>

#include "modules/muscle/kernels/surface/step_surface.hpp"

namespace fascicle::muscle {

// Bones at the step's end, by bone that the muscle collides with.
void place_bones(const SurfaceStep& step, std::span<SurfaceBone> bones);

// Every free vertex of step.points that is too near to a bone goes to its surface; one that is deep goes back towards
// its place in `before`, where that is outside. `balls` and `near` are scratch, for all vertices. `touches` keep the most
// vertices and the greatest depth of all calls: a muscle that is pressed and comes to rest beside the bone touches it.
// Returns whether any vertex was moved.
bool push_out(const SurfaceStep& step, std::span<const SurfaceBone> bones, std::span<const SurfacePoint> before,
              std::span<VertexBall> balls, std::span<std::uint32_t> near, std::span<BoneTouch> touches);

}  // namespace fascicle::muscle
