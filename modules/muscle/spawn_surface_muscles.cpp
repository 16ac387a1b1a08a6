#include "modules/muscle/spawn_surface_muscles.hpp"

#include <algorithm>

#include <glm/matrix.hpp>

#include "engine/ecs/world.hpp"
#include "engine/loop/cost_ledger.hpp"
#include "engine/math/state_hash.hpp"
#include "modules/muscle/asset/muscle_asset.hpp"
#include "modules/muscle/components/musculature.hpp"
#include "modules/muscle/components/surface_hull.hpp"
#include "modules/muscle/components/surface_muscle.hpp"
#include "modules/muscle/join_neighbours.hpp"

namespace fascicle::muscle {

ecs::Entity spawn_surface_muscle(ecs::World& world, ecs::Entity character, std::shared_ptr<const SurfaceAsset> asset,
                                 std::span<const glm::mat4> rest_bones,
                                 std::span<const std::shared_ptr<const BoneField>> fields, ecs::Entity musculature) {
  SurfaceMuscle muscle;
  muscle.character = character;
  muscle.rest_bones.assign(rest_bones.begin(), rest_bones.end());
  muscle.fields.assign(fields.begin(), fields.end());
  muscle.fields.resize(rest_bones.size());
  muscle.settings = asset->settings;
  if (const Musculature* driver = world.try_get<Musculature>(musculature); driver != nullptr) {
    const std::int32_t index = find_muscle(*driver->asset, asset->driver);
    if (index >= 0) {
      muscle.musculature = musculature;
      muscle.driver = static_cast<std::uint32_t>(index);
    }
  }

  SurfaceState state;
  state.points = asset->rest;
  state.velocity.assign(asset->rest.size(), SurfacePoint{});
  state.bones.assign(rest_bones.size(), glm::mat4(1.0f));
  state.attachment_motion.assign(asset->attachments.size(), RigidMotion{});
  state.carrier_motion.assign(asset->carriers.size(), RigidMotion{});
  state.bone_motion.assign(asset->bones.size(), RigidMotion{});
  for (const std::int32_t bone : asset->bones) {
    const auto b = static_cast<std::size_t>(bone);
    state.fields.push_back(muscle.fields[b].get());
    state.rest_to_bone.push_back(glm::inverse(rest_bones[b]));
  }
  state.volume = asset->volume;
  lay_out(*asset, state.scratch);

  SurfaceContacts contacts;
  contacts.now.reserve(asset->bones.size());
  DrawnSurface drawn;
  drawn.vertices.assign(asset->vertex_count, SurfaceVertex{});
  muscle.asset = std::move(asset);

  const ecs::Entity entity = world.create();
  world.add(entity, std::move(muscle));
  world.add(entity, std::move(state));
  world.add(entity, std::move(contacts));
  world.add(entity, std::move(drawn));
  join_neighbours(world, entity);
  return entity;
}

void despawn_surface_muscle(ecs::World& world, ecs::Entity muscle) {
  if (world.try_get<SurfaceMuscle>(muscle) == nullptr) return;
  if (CostLedger* ledger = world.try_resource<CostLedger>()) ledger->remove_owner(muscle);
  leave_neighbours(world, muscle);
  world.destroy(muscle);
}

void list_surface_costs(ecs::World& world, ecs::Entity muscle, std::string label) {
  CostLedger* ledger = world.try_resource<CostLedger>();
  if (ledger == nullptr || world.try_get<SurfaceMuscle>(muscle) == nullptr) return;
  ledger->add_owner(muscle, std::move(label), {});
}

std::uint64_t hash_surface_state(const ecs::World& world) {
  StateHash hash;
  world.view<const SurfaceMuscle, const SurfaceState>().each([&](ecs::Entity entity, const SurfaceMuscle&,
                                                                 const SurfaceState& state) {
    hash.add(std::span<const SurfacePoint>(state.points));
    hash.add(std::span<const SurfacePoint>(state.velocity));
    const SurfaceHull* hull = world.try_get<const SurfaceHull>(entity);
    if (hull == nullptr) return;
    hash.add(hull->switches);
    hash.add(hull->level);
    hash.add(hull->blend_left);
    if (hull->blend_left > 0.0f) hash.add(std::span<const SurfacePoint>(hull->difference));
  });
  return hash.value();
}

}  // namespace fascicle::muscle
