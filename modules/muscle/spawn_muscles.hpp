// From an asset to entities and back. These change the world's structure: call them outside of the schedule, or inside
// Commands::run.
//
//   ecs::Entity muscles = spawn_musculature(world, character, asset);
//   const MuscleSurfaceView soleus = surface_of(world, muscle_entity(world, muscles, "soleus_r"));
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "engine/ecs/entity.hpp"
#include "modules/muscle/components/muscle_settings.hpp"
#include "modules/muscle/components/muscle_surfaces.hpp"

namespace fascicle::ecs {
class World;
}

namespace fascicle::muscle {

struct CollisionAsset;
struct CollisionSettings;
struct MuscleAsset;
struct MuscleLevels;

// Must be called once per world before a schedule with muscle systems runs; again to change the settings. Gives the
// world the resources MuscleSettings and, where it has none, Viewer (components/muscle_detail.hpp; nobody looks),
// CostLedger (engine/loop/cost_ledger.hpp), FrameTime and CollisionScratch.
// A SIMD level that the processor lacks is lowered to the best it has.
void prepare_muscles(ecs::World& world, const MuscleSettings& settings = {});

// Makes a musculature of `asset` for `character`, which must have BoneMatrices with at least asset->bone_count
// matrices by the time the systems run, and an entity for each muscle. Everything that frames need is allocated here.
// Until the first step the state is the rest shape, in the rest bones' space.
ecs::Entity spawn_musculature(ecs::World& world, ecs::Entity character, std::shared_ptr<const MuscleAsset> asset);

// The same with several levels of detail (asset/muscle_levels.hpp), the finest at first; `select_levels` goes by what
// the world's resource Viewer sees of it. Surfaces and their indices change with the level.
ecs::Entity spawn_musculature(ecs::World& world, ecs::Entity character, std::shared_ptr<const MuscleLevels> levels);

// Lets the muscles of a musculature collide with bones and each other from the next step on: gives it MuscleCollision
// and MuscleContacts. `levels` belong to the assets that it was spawned with, in their order.
void add_collision(ecs::World& world, ecs::Entity musculature,
                   std::span<const std::shared_ptr<const CollisionAsset>> levels, const CollisionSettings& settings);

// Ends one muscle: its entity is destroyed, its surface collapses to its origin's place and draws nothing, its
// measures are zero. The others go on. No effect on an entity that is not a muscle.
void detach_muscle(ecs::World& world, ecs::Entity muscle);

// Destroys the musculature and its muscles' entities; the character stays. No effect where there is none.
void despawn_musculature(ecs::World& world, ecs::Entity musculature);

// The entity of a muscle by its index or name; kNoEntity where it is detached or unknown.
ecs::Entity muscle_entity(const ecs::World& world, ecs::Entity musculature, std::uint32_t index);
ecs::Entity muscle_entity(const ecs::World& world, ecs::Entity musculature, std::string_view name);

// Lists a musculature and its muscles in the world's CostLedger, so that the systems' times appear per muscle when the
// ledger is on. `despawn_musculature` takes it out again.
void list_costs(ecs::World& world, ecs::Entity musculature, std::string label);

// The muscle's current surface, until the next step; empty for an entity that is not a muscle.
MuscleSurfaceView surface_of(const ecs::World& world, ecs::Entity muscle);

// Current functional length, m; zero for an entity that is not a muscle.
float length_of(const ecs::World& world, ecs::Entity muscle);

// A 64-bit hash of all musculatures' state (lines, frames, radii, tendons, measures, surfaces), in the order in which
// the world stores them. Equal on all instruction sets and thread numbers.
std::uint64_t hash_state(const ecs::World& world);

}  // namespace fascicle::muscle
