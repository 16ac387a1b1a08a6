// Surface muscles from an asset to entities and back. These change the world's structure: call them outside of the
// schedule, or inside Commands::run.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include <glm/mat4x4.hpp>

#include "engine/ecs/entity.hpp"
#include "modules/muscle/asset/surface/surface_asset.hpp"

namespace fascicle::ecs {
class World;
}

namespace fascicle::muscle {

class BoneField;

// Gives `character` a surface muscle: an entity with SurfaceMuscle, SurfaceState, SurfaceContacts and DrawnSurface.
// `rest_bones`: the skeleton's matrices at rest, as many as the asset was built for; `fields`: of the bones that have
// one, by bone, or empty. `musculature` has the asset's driver; without one, or without that muscle in it, the shape
// stays where its attachments let it. Until the first step it stands at rest. Everything that frames need is allocated
// here. prepare_muscles must have been called for the world.
ecs::Entity spawn_surface_muscle(ecs::World& world, ecs::Entity character, std::shared_ptr<const SurfaceAsset> asset,
                                 std::span<const glm::mat4> rest_bones,
                                 std::span<const std::shared_ptr<const BoneField>> fields,
                                 ecs::Entity musculature = ecs::kNoEntity);

// No effect on an entity that is no surface muscle.
void despawn_surface_muscle(ecs::World& world, ecs::Entity muscle);

// Lists it in the world's CostLedger, so that the systems' times appear for it when the ledger is on.
void list_surface_costs(ecs::World& world, ecs::Entity muscle, std::string label);

// A 64-bit hash of all surface muscles' points and velocities, and of how far changes of solver are blended, in the
// order in which the world stores them.
std::uint64_t hash_surface_state(const ecs::World& world);

}  // namespace fascicle::muscle
