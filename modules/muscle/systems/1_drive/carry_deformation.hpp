// System, 1 drive: what collision has moved and pressed is carried along: displacements turn with their bones onto the
// lines that the bones have just placed, and a change of the level of detail takes them over.
#pragma once

#include "engine/animation/skeleton.hpp"
#include "engine/ecs/view.hpp"
#include "modules/muscle/components/action_lines.hpp"
#include "modules/muscle/components/muscle_collision.hpp"
#include "modules/muscle/components/musculature.hpp"

namespace fascicle::muscle {

void carry_deformation(ecs::View<const Musculature, MuscleCollision, ActionLines> musculatures,
                       ecs::View<const BoneMatrices> characters);

}  // namespace fascicle::muscle
