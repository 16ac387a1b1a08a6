// Which surface muscles of a character may touch: kept on the character's entity as muscles are spawned and despawned.
#pragma once

#include "engine/ecs/entity.hpp"

namespace fascicle::ecs {
class World;
}

namespace fascicle::muscle {

// Pairs a new surface muscle with all others of its character, where both collide with muscles; how deep the two are in
// each other at rest is found here. spawn_surface_muscle calls it.
void join_neighbours(ecs::World& world, ecs::Entity muscle);

// Before it is despawned.
void leave_neighbours(ecs::World& world, ecs::Entity muscle);

}  // namespace fascicle::muscle
