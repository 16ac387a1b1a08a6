// A surface muscle's change from one solver's shape to another's, faded. What the old shape differs from the new one
// at the change is added to the new one less and less. Both have the muscle's volume, their mix has not quite; one
// Newton step, which moves few of them far, mends that, and what the mix leaves inside bones is pushed out.
//
//   begin      carry_along(step, ..., difference)           the old shape, where the carriers take it in the step
//              pose_surface(step, ...)                      the new shape
//              take_difference(step, ..., difference)
//   each step  pose_surface(step, ...), then add_difference(step, fading(left / time), difference, ...)
#pragma once

#include <span>

#include "modules/muscle/kernels/surface/step_surface.hpp"

namespace fascicle::muscle {

// `places` = the step's points, where the carriers' motion in this step takes them. By vertex.
void carry_along(const SurfaceStep& step, SurfaceScratch& scratch, std::span<SurfacePoint> places);

// `places` less the step's points; nothing of attached vertices. Returns the same of the volumes (m^3).
double take_difference(const SurfaceStep& step, SurfaceScratch& scratch, std::span<SurfacePoint> places);

// How much of a difference is left, with `part` (0..1) of the time left: 3 p^2 - 2 p^3, so it begins and ends slowly.
// A part that is no number has none left.
float fading(float part);

// Adds `share` of a difference to the step's points. `touches`: by bone; what is pushed out of one is taken into them.
// Returns the volume (m^3).
double add_difference(const SurfaceStep& step, float share, std::span<const SurfacePoint> difference,
                      double volume_difference, SurfaceScratch& scratch, std::span<BoneTouch> touches);

}  // namespace fascicle::muscle
