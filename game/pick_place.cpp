#include "game/pick_place.hpp"

#include <limits>
#include <vector>

#include "engine/animation/skeleton.hpp"
#include "modules/muscle/content/tag_place.hpp"
#include "modules/muscle/muscle.hpp"
#include "modules/muscle/systems/5_present/pick_muscle.hpp"

namespace fascicle::game {
namespace {

std::optional<muscle::MusclePick> pick_of(const Simulation& simulation, const SpawnedCharacter& character,
                                          const PickFilter& filter, const Ray& ray) {
  const ecs::World& world = simulation.world();
  const muscle::Musculature& musculature = world.get<muscle::Musculature>(character.musculature);
  const muscle::MuscleAsset& asset = *musculature.asset;
  std::vector<std::uint8_t> hidden(asset.size(), 0);
  for (std::size_t m = 0; m < asset.size(); ++m) {
    const bool shut = filter.is_hidden && filter.is_hidden(asset.muscles[m].name);
    hidden[m] = shut || musculature.attached[m] == 0 ? 1 : 0;
  }
  return muscle::pick_muscle(asset, world.get<muscle::MuscleSurfaces>(character.musculature),
                             world.get<muscle::Tendons>(character.musculature), hidden, ray);
}

}  // namespace

std::optional<PickedPlace> pick_place(const Simulation& simulation, const PickFilter& filter, const Ray& ray) {
  float nearest = std::numeric_limits<float>::infinity();
  std::optional<PickedPlace> found;
  for (std::size_t i = 0; i < simulation.characters().size(); ++i) {
    const SpawnedCharacter& character = simulation.characters()[i];
    if (filter.muscles && character.musculature != ecs::kNoEntity) {
      const auto pick = pick_of(simulation, character, filter, ray);
      if (pick && pick->distance < nearest) {
        nearest = pick->distance;
        const muscle::MuscleAsset& asset =
            *simulation.world().get<muscle::Musculature>(character.musculature).asset;
        found = PickedPlace{i, asset.muscles[pick->muscle].name, -1,
                            muscle::tag_of(asset, pick->muscle, pick->section, pick->vertex)};
      }
    }
    if (!filter.bones) continue;
    const std::vector<glm::mat4>& bones = simulation.world().get<BoneMatrices>(character.entity).world;
    for (const muscle::BoneMesh& mesh : character.asset->bone_meshes) {
      const auto bone = static_cast<std::size_t>(mesh.bone);
      const auto distance = hit_mesh(ray, *mesh.mesh, bones[bone] * mesh.transform);
      if (!distance || *distance >= nearest) continue;
      nearest = *distance;
      found = PickedPlace{i, character.asset->skeleton->names[bone], mesh.bone, {}};
    }
  }
  return found;
}

}  // namespace fascicle::game
