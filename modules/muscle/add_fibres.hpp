// Gives a surface muscle its fibres. Changes the world's structure: call it outside of the schedule, or inside
// Commands::run.
#pragma once

#include <memory>

#include "engine/ecs/entity.hpp"

namespace fascicle::ecs {
class World;
}

namespace fascicle::muscle {

struct FibreBundleAsset;

// `muscle` has SurfaceMuscle and SurfaceState of the surface that the bundle was built for, or nothing happens. From
// the next step on its component FibreBundle holds places and lengths; until then those at rest. Everything that steps
// need is allocated here.
void add_fibres(ecs::World& world, ecs::Entity muscle, std::shared_ptr<const FibreBundleAsset> bundle);

}  // namespace fascicle::muscle
