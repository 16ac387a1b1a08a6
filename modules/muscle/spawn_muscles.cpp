#include "modules/muscle/spawn_muscles.hpp"

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

#include "engine/ecs/world.hpp"
#include "engine/loop/cost_ledger.hpp"
#include "engine/math/state_hash.hpp"
#include "engine/loop/frame_time.hpp"
#include "modules/muscle/asset/collision/collision_asset.hpp"
#include "modules/muscle/asset/muscle_asset.hpp"
#include "modules/muscle/asset/muscle_levels.hpp"
#include "modules/muscle/components/collision_scratch.hpp"
#include "modules/muscle/components/lay_out_state.hpp"
#include "modules/muscle/components/muscle_collision.hpp"
#include "modules/muscle/components/muscle_detail.hpp"
#include "modules/muscle/components/musculature.hpp"
#include "modules/muscle/systems/5_present/measure_muscles.hpp"
#include "modules/muscle/systems/5_present/write_surfaces.hpp"
#include "modules/muscle/systems/kernel_jobs.hpp"

namespace fascicle::muscle {
namespace {

// The systems whose time the ledger knows.
constexpr std::array<std::string_view, 10> kTimedSystems = {
    "select_levels",   "drive_action_lines", "build_frames",          "find_tendons",         "solve_muscles",
    "measure_muscles", "write_surfaces",     "solve_surface_muscles", "pose_surface_muscles", "write_surface_muscles"};

// Room for pairs that touch: a muscle among its neighbours and bones.
constexpr std::size_t kContactsPerMuscle = 8;

template <class T>
void hash_arrays(std::initializer_list<const AlignedVector<T>*> arrays, StateHash& hash) {
  for (const AlignedVector<T>* array : arrays) hash.add(std::span<const T>(*array));
}

// At rest at the first of the levels, with room for all of them.
ecs::Entity spawn(ecs::World& world, ecs::Entity character,
                  std::span<const std::shared_ptr<const MuscleAsset>> levels) {
  const MuscleAsset& asset = *levels.front();
  const ecs::Entity entity = world.create();
  Musculature musculature;
  musculature.asset = levels.front();
  musculature.character = character;
  musculature.attached.assign(asset.size(), 1);
  for (std::uint32_t i = 0; i < asset.size(); ++i) {
    const ecs::Entity muscle = world.create();
    world.add(muscle, Muscle{.musculature = entity, .index = i});
    musculature.muscles.push_back(muscle);
  }

  ActionLines lines;
  CrossSections sections;
  Tendons tendons;
  MuscleMeasures measures;
  MuscleSurfaces surfaces;
  for (std::size_t level = levels.size(); level-- > 0;) {
    lay_out(*levels[level], lines);
    lay_out(*levels[level], sections);
    lay_out(*levels[level], surfaces);
  }
  lay_out(asset, tendons);
  lay_out(asset, measures);
  const MtuKernels& kernels = mtu_kernels(SimdLevel::kPortable);
  kernels.find_tendons(find_tendons_job(asset, sections, tendons));
  for (std::uint32_t i = 0; i < asset.size(); ++i) {
    measure_muscle(musculature, lines, sections, tendons, kernels, i, measures);
  }
  kernels.write_surfaces(write_surfaces_job(sections_view(musculature, lines, sections, tendons), false, surfaces));
  write_rows(asset, sections, tendons, surfaces);

  world.add(entity, std::move(musculature));
  world.add(entity, std::move(lines));
  world.add(entity, std::move(sections));
  world.add(entity, std::move(tendons));
  world.add(entity, std::move(measures));
  world.add(entity, std::move(surfaces));
  return entity;
}

}  // namespace

void prepare_muscles(ecs::World& world, const MuscleSettings& settings) {
  MuscleSettings usable = settings;
  usable.simd = std::min(settings.simd, detect_simd());
  world.set_resource(usable);
  if (world.try_resource<Viewer>() == nullptr) world.set_resource(Viewer{});
  if (world.try_resource<CostLedger>() == nullptr) world.set_resource(CostLedger{});
  if (world.try_resource<FrameTime>() == nullptr) world.set_resource(FrameTime{});
  if (world.try_resource<CollisionScratch>() == nullptr) world.set_resource(CollisionScratch{});
  for (const std::string_view system : kTimedSystems) world.resource<CostLedger>().add_system(system);
}

ecs::Entity spawn_musculature(ecs::World& world, ecs::Entity character, std::shared_ptr<const MuscleAsset> asset) {
  return spawn(world, character, std::span(&asset, 1));
}

ecs::Entity spawn_musculature(ecs::World& world, ecs::Entity character, std::shared_ptr<const MuscleLevels> levels) {
  const ecs::Entity entity = spawn(world, character, levels->assets);
  if (levels->morphs.empty()) return entity;
  const MuscleAsset& finest = *levels->assets.front();
  world.get<Musculature>(entity).coarser = levels->morphs.data();
  world.get<CrossSections>(entity).ends = finest.ends;
  world.add(entity, MuscleDetail{.levels = std::move(levels), .twist = std::vector<float>(finest.size())});
  return entity;
}

void add_collision(ecs::World& world, ecs::Entity musculature,
                   std::span<const std::shared_ptr<const CollisionAsset>> levels, const CollisionSettings& settings) {
  if (levels.empty()) return;
  MuscleCollision collision;
  collision.settings = settings;
  collision.levels.assign(levels.begin(), levels.end());
  for (std::size_t level = levels.size(); level-- > 0;) {
    lay_out(*levels[level], collision);
    world.resource<CollisionScratch>().reserve(*levels[level]);
  }
  collision.pose.reserve(levels.front()->bone_count);
  for (AlignedVector<float>& carried : collision.carried) carried.reserve(collision.radii.size());
  MuscleContacts contacts;
  const std::size_t pairs = kContactsPerMuscle * levels.front()->muscles->size();
  for (std::vector<MuscleContact>* list : {&contacts.now, &contacts.began, &contacts.ended, &contacts.gone}) {
    list->reserve(pairs);
  }
  world.add(musculature, std::move(collision));
  world.add(musculature, std::move(contacts));
}

void detach_muscle(ecs::World& world, ecs::Entity entity) {
  const Muscle* found = world.try_get<Muscle>(entity);
  if (found == nullptr) return;
  const Muscle muscle = *found;
  world.destroy(entity);
  Musculature* musculature = world.try_get<Musculature>(muscle.musculature);
  if (musculature == nullptr) return;
  musculature->muscles[muscle.index] = ecs::kNoEntity;
  musculature->attached[muscle.index] = 0;
  if (MuscleCollision* collision = world.try_get<MuscleCollision>(muscle.musculature)) collision->still = 0.0f;
  const ActionLines& lines = world.get<ActionLines>(muscle.musculature);
  const CrossSections& sections = world.get<CrossSections>(muscle.musculature);
  const Tendons& tendons = world.get<Tendons>(muscle.musculature);
  const MtuKernels& kernels = mtu_kernels(SimdLevel::kPortable);
  const SectionsView view = single_muscle(sections_view(*musculature, lines, sections, tendons), muscle.index);
  kernels.write_surfaces(write_surfaces_job(view, false, world.get<MuscleSurfaces>(muscle.musculature)));
  measure_muscle(*musculature, lines, sections, tendons, kernels, muscle.index,
                 world.get<MuscleMeasures>(muscle.musculature));
}

void despawn_musculature(ecs::World& world, ecs::Entity entity) {
  const Musculature* musculature = world.try_get<Musculature>(entity);
  if (musculature == nullptr) return;
  const std::vector<ecs::Entity> muscles = musculature->muscles;
  for (const ecs::Entity muscle : muscles) {
    if (world.alive(muscle)) world.destroy(muscle);
  }
  if (CostLedger* ledger = world.try_resource<CostLedger>()) ledger->remove_owner(entity);
  world.destroy(entity);
}

ecs::Entity muscle_entity(const ecs::World& world, ecs::Entity musculature, std::uint32_t index) {
  const Musculature* found = world.try_get<Musculature>(musculature);
  return found != nullptr && index < found->muscles.size() ? found->muscles[index] : ecs::kNoEntity;
}

ecs::Entity muscle_entity(const ecs::World& world, ecs::Entity musculature, std::string_view name) {
  const Musculature* found = world.try_get<Musculature>(musculature);
  if (found == nullptr) return ecs::kNoEntity;
  const std::int32_t index = find_muscle(*found->asset, name);
  return index < 0 ? ecs::kNoEntity : found->muscles[static_cast<std::size_t>(index)];
}

void list_costs(ecs::World& world, ecs::Entity musculature, std::string label) {
  const Musculature* found = world.try_get<Musculature>(musculature);
  CostLedger* ledger = world.try_resource<CostLedger>();
  if (found == nullptr || ledger == nullptr) return;
  std::vector<std::string> names;
  for (const MuscleLayout& muscle : found->asset->muscles) names.push_back(muscle.name);
  ledger->add_owner(musculature, std::move(label), names);
}

MuscleSurfaceView surface_of(const ecs::World& world, ecs::Entity entity) {
  const Muscle* muscle = world.try_get<Muscle>(entity);
  if (muscle == nullptr) return {};
  const Musculature* musculature = world.try_get<Musculature>(muscle->musculature);
  const MuscleSurfaces* surfaces = world.try_get<MuscleSurfaces>(muscle->musculature);
  if (musculature == nullptr || surfaces == nullptr) return {};
  return surface_of(*musculature->asset, *surfaces, muscle->index);
}

float length_of(const ecs::World& world, ecs::Entity entity) {
  const Muscle* muscle = world.try_get<Muscle>(entity);
  const MuscleMeasures* measures = muscle == nullptr ? nullptr : world.try_get<MuscleMeasures>(muscle->musculature);
  return measures == nullptr ? 0.0f : measures->length[muscle->index];
}

std::uint64_t hash_state(const ecs::World& world) {
  StateHash hash;
  world
      .view<const Musculature, const ActionLines, const CrossSections, const Tendons, const MuscleMeasures,
            const MuscleSurfaces>()
      .each([&](const Musculature& musculature, const ActionLines& lines, const CrossSections& sections,
                const Tendons& tendons, const MuscleMeasures& measures, const MuscleSurfaces& surfaces) {
        hash.add(std::span<const std::uint8_t>(musculature.attached));
        hash_arrays<float>({&lines.x, &lines.y, &lines.z, &sections.ux, &sections.uy, &sections.uz, &sections.vx,
                            &sections.vy, &sections.vz, &sections.arc, &sections.twist, &sections.radii},
                           hash);
        for (std::size_t end = 0; end < 2; ++end) {
          hash_arrays<std::int32_t>({&tendons.segment[end]}, hash);
          hash_arrays<float>({&tendons.fraction[end]}, hash);
        }
        hash.add(std::span<const float>(measures.length));
        hash.add(std::span<const float>(measures.volume));
        hash.add(std::span<const SurfaceVertex>(surfaces.vertices));
        hash.add(std::span<const SurfaceRow>(surfaces.rows));
      });
  return hash.value();
}

}  // namespace fascicle::muscle
