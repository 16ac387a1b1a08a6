// What collision has moved and pressed, taken over from one level of detail to another, and the shape at rest that it
// comes back to.
#pragma once

#include <span>

#include <glm/mat4x4.hpp>

#include "modules/muscle/components/action_lines.hpp"
#include "modules/muscle/components/muscle_collision.hpp"
#include "modules/muscle/components/musculature.hpp"

namespace fascicle::muscle {

// Brings the deformation into the order of the musculature's present asset; `collision.asset` is null where that has no
// collision. Allocates nothing.
void carry_deformation(const Musculature& musculature, MuscleCollision& collision);

// Moves the centres on the lines, as the bones have just placed them, by the displacements that are kept.
void displace_lines(const MuscleCollision& collision, std::span<const glm::mat4> bones, ActionLines& lines);

}  // namespace fascicle::muscle
