// What the solve found, for games: one entry a pair that touches, and which of them are new or gone.
#pragma once

#include "modules/muscle/components/muscle_collision.hpp"
#include "modules/muscle/kernels/collision/collision_work.hpp"

namespace fascicle::muscle {

void report_contacts(const CollisionAsset& asset, const CollisionWork& work, MuscleCollision& collision,
                     MuscleContacts& contacts);

}  // namespace fascicle::muscle
