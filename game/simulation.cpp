#include "game/simulation.hpp"

#include <algorithm>
#include <cmath>
#include <span>

#include "engine/animation/joint_systems.hpp"
#include "engine/animation/pose_systems.hpp"
#include "engine/animation/skinning_systems.hpp"
#include "engine/math/state_hash.hpp"
#include "modules/muscle/add_fibres.hpp"
#include "modules/muscle/components/surface_muscle.hpp"
#include "modules/muscle/muscle.hpp"
#include "modules/muscle/spawn_surface_muscles.hpp"
#include "modules/muscle/systems/4_solve/solve_as_legacy.hpp"

namespace fascicle::game {
namespace {

constexpr int kMaxCatchUpSteps = 4;
constexpr float kCopySpacing = 1.4f;             // m between copies on the grid
constexpr float kPhaseOfCopy = 0.61803398875f;   // each copy is this fraction of a cycle ahead of the one before

// Copies stand on a square grid, row after row away from the camera; copy 0 stands where the scene says.
glm::vec3 grid_offset(int copy, int copies) {
  if (copies <= 1) return glm::vec3(0.0f);
  const int columns = static_cast<int>(std::ceil(std::sqrt(static_cast<double>(copies))));
  return {kCopySpacing * static_cast<float>(copy % columns), 0.0f, -kCopySpacing * static_cast<float>(copy / columns)};
}

float fraction(float x) { return x - std::floor(x); }

}  // namespace

Simulation::Simulation(std::shared_ptr<const muscle::SceneAsset> scene, const SimulationOptions& options)
    : scene_(std::move(scene)), options_(options), workers_(options.workers),
      loop_(1.0f / scene_->step_hz, kMaxCatchUpSteps) {
  world_.set_resource(loop_.time());
  muscle::prepare_muscles(world_, {.simd = options_.simd});

  schedule_.add("advance_clips", advance_clips);
  schedule_.add("sample_clips", sample_clips);
  schedule_.add("advance_motions", advance_motions);
  schedule_.add("sample_motions", sample_motions);
  schedule_.add("pose_joint_models", pose_joint_models);
  schedule_.add("compose_bones", compose_bones);
  if (options_.skin_meshes) schedule_.add("skin_meshes", fascicle::skin_meshes);
  muscle::add_muscle_systems(schedule_);

  spawn_all();
}

void Simulation::step() {
  world_.resource<FrameTime>() = loop_.advance();
  schedule_.run(world_, workers_);
  ++steps_;
  if (steps_ == 1) start_ = root_position();
}

// Bone 0 of a joint model is the fixed ground; the bone after it carries the character.
glm::vec3 Simulation::root_position() const {
  if (characters_.empty()) return glm::vec3(0.0f);
  const SpawnedCharacter& first = characters_.front();
  const std::vector<glm::mat4>& world = world_.get<BoneMatrices>(first.entity).world;
  return glm::vec3(world[first.asset->joints && world.size() > 1 ? 1 : 0][3]);
}

glm::vec3 Simulation::travel() const {
  const glm::vec3 moved = root_position() - start_;
  return steps_ == 0 ? glm::vec3(0.0f) : glm::vec3(moved.x, 0.0f, moved.z);
}

void Simulation::spawn_all() {
  for (int copy = 0; copy < options_.copies; ++copy) {
    for (std::size_t i = 0; i < scene_->characters.size(); ++i) characters_.push_back(spawn(i, copy));
  }
}

void Simulation::despawn_all() {
  for (const SpawnedCharacter& character : characters_) {
    for (const ecs::Entity surface : character.surfaces) muscle::despawn_surface_muscle(world_, surface);
    muscle::despawn_musculature(world_, character.musculature);
    for (const ecs::Entity skin : character.skins) world_.destroy(skin);
    world_.destroy(character.entity);
  }
  characters_.clear();
}

SpawnedCharacter Simulation::spawn(std::size_t scene_index, int copy) {
  const muscle::SceneCharacter& placed = scene_->characters[scene_index];
  const muscle::CharacterAsset& asset = *placed.character;
  SpawnedCharacter spawned{.asset = placed.character, .scene_index = scene_index, .entity = world_.create(),
                           .musculature = ecs::kNoEntity, .skins = {}};

  world_.add(spawned.entity, Placement{.position = placed.position + grid_offset(copy, options_.copies),
                                       .rotation = glm::angleAxis(placed.heading, glm::vec3(0.0f, 1.0f, 0.0f))});
  world_.add(spawned.entity, LocalPose{asset.skeleton, asset.skeleton->rest_local});
  world_.add(spawned.entity, BoneMatrices{asset.skeleton->rest_world, 0});

  const float phase = fraction(placed.animation.phase + kPhaseOfCopy * static_cast<float>(copy));
  if (placed.animation.clip) {
    world_.add(spawned.entity, ClipPlayer{.clip = placed.animation.clip,
                                          .time = phase * placed.animation.clip->duration(),
                                          .speed = placed.animation.speed,
                                          .in_place = placed.in_place});
  }
  if (asset.joints) {
    world_.add(spawned.entity, make_coordinate_pose(asset.joints));
    if (placed.animation.motion) {
      world_.add(spawned.entity, MotionPlayer{.motion = placed.animation.motion,
                                              .time = static_cast<double>(phase) *
                                                      placed.animation.motion->cycle.length(),
                                              .speed = static_cast<double>(placed.animation.speed),
                                              .in_place = placed.in_place});
    }
  }
  if (asset.levels) spawned.musculature = muscle::spawn_musculature(world_, spawned.entity, asset.levels);
  if (asset.levels && options_.collision) {
    muscle::add_collision(world_, spawned.musculature, asset.collision_levels, asset.collision.settings);
    if (asset.collision.settings.mode == muscle::CollisionMode::kLegacy) add_legacy_collision(world_, spawned);
  }
  spawn_surfaces(spawned);
  for (const std::shared_ptr<const SkinAsset>& skin : asset.skins) {
    const ecs::Entity entity = world_.create();
    world_.add(entity, SkinInstance{skin, spawned.entity});
    world_.add(entity, make_skinned_surface(*skin));
    spawned.skins.push_back(entity);
  }
  return spawned;
}

void Simulation::spawn_surfaces(SpawnedCharacter& spawned) {
  const muscle::CharacterAsset& asset = *spawned.asset;
  for (std::size_t i = 0; i < asset.surface_muscles.size(); ++i) {
    const ecs::Entity entity =
        muscle::spawn_surface_muscle(world_, spawned.entity, asset.surface_muscles[i], asset.skeleton->rest_world,
                                     asset.bone_fields, spawned.musculature);
    if (!options_.collision) {
      muscle::SurfaceSettings& settings = world_.get<muscle::SurfaceMuscle>(entity).settings;
      settings.collide_with_bones = settings.collide_with_itself = settings.collide_with_muscles = false;
    }
    if (asset.fibre_bundles[i]) muscle::add_fibres(world_, entity, asset.fibre_bundles[i]);
    muscle::add_hull(world_, entity, asset.hulls[i]);
    if (muscle::SurfaceHull* hull = world_.try_get<muscle::SurfaceHull>(entity)) hull->forced = options_.surface_solver;
    spawned.surfaces.push_back(entity);
  }
}

void Simulation::swap_scene(std::shared_ptr<const muscle::SceneAsset> scene) {
  struct PlayerState {
    muscle::AnimationChoice choice;
    float clip_time = 0.0f;
    double motion_time = 0.0;
  };
  std::vector<PlayerState> states;
  for (const SpawnedCharacter& character : characters_) {
    const ClipPlayer* clip = world_.try_get<ClipPlayer>(character.entity);
    const MotionPlayer* motion = world_.try_get<MotionPlayer>(character.entity);
    states.push_back({scene_->characters[character.scene_index].animation, clip ? clip->time : 0.0f,
                      motion ? motion->time : 0.0});
  }
  const std::size_t before = scene_->characters.size();
  despawn_all();
  scene_ = std::move(scene);
  loop_.set_step(1.0f / scene_->step_hz);
  spawn_all();

  // Each goes on from where it is; one whose phase or speed was edited stands where a fresh start would have brought it.
  const std::size_t now = scene_->characters.size();
  for (std::size_t i = 0; i < characters_.size(); ++i) {
    const std::size_t place = characters_[i].scene_index;
    if (place >= before) continue;
    const PlayerState& state = states[i / now * before + place];
    const muscle::AnimationChoice& choice = scene_->characters[place].animation;
    const bool goes_on = choice.phase == state.choice.phase && choice.speed == state.choice.speed;
    const double elapsed = static_cast<double>(choice.speed) * loop_.time().time;
    if (ClipPlayer* clip = world_.try_get<ClipPlayer>(characters_[i].entity)) {
      clip->time = goes_on ? state.clip_time : clip->time + static_cast<float>(elapsed);
    }
    if (MotionPlayer* motion = world_.try_get<MotionPlayer>(characters_[i].entity)) {
      motion->time = goes_on ? state.motion_time : motion->time + elapsed;
    }
  }
  refresh();
  start_ = root_position();
}

void Simulation::refresh() {
  FrameTime standing = loop_.time();
  standing.step = 0.0f;
  world_.resource<FrameTime>() = standing;
  schedule_.run(world_, workers_);
}

std::uint64_t Simulation::hash() const {
  StateHash hash;
  hash.add(steps_);
  for (const SpawnedCharacter& character : characters_) {
    hash.add(std::span<const glm::mat4>(world_.get<BoneMatrices>(character.entity).world));
  }
  hash.add(muscle::hash_state(world_));
  hash.add(muscle::hash_surface_state(world_));
  return hash.value();
}

std::uint64_t Simulation::held_steps() const {
  std::uint64_t held = 0;
  for (const SpawnedCharacter& character : characters_) {
    held += world_.get<BoneMatrices>(character.entity).held_steps;
    if (character.musculature == ecs::kNoEntity) continue;
    held += world_.get<muscle::ActionLines>(character.musculature).held_steps;
  }
  return held;
}

Simulation::DetailCounts Simulation::count_details() const {
  DetailCounts counts;
  std::size_t musculatures = 0;
  for (const SpawnedCharacter& character : characters_) {
    if (character.musculature == ecs::kNoEntity) continue;
    const muscle::Musculature& musculature = world_.get<muscle::Musculature>(character.musculature);
    const muscle::MuscleDetail* detail = world_.try_get<muscle::MuscleDetail>(character.musculature);
    const std::size_t level = detail == nullptr ? 0 : detail->level;
    if (counts.characters.size() <= level) counts.characters.resize(level + 1);
    ++counts.characters[level];
    counts.mean_level += static_cast<double>(level) + static_cast<double>(musculature.morph);
    counts.switches += detail == nullptr ? 0 : detail->switches;
    counts.vertices += musculature.asset->vertex_count;
    ++musculatures;
  }
  if (musculatures > 0) counts.mean_level /= static_cast<double>(musculatures);
  return counts;
}

void Simulation::record_metrics(Report& report) const {
  double length = 0.0, volume = 0.0, worst_stretch = 0.0;
  std::size_t muscles = 0;
  for (const SpawnedCharacter& character : characters_) {
    if (character.musculature == ecs::kNoEntity) continue;
    const muscle::MuscleMeasures& measures = world_.get<muscle::MuscleMeasures>(character.musculature);
    const muscle::MuscleAsset& asset = *world_.get<muscle::Musculature>(character.musculature).asset;
    for (std::size_t m = 0; m < asset.size(); ++m) {
      length += static_cast<double>(measures.length[m]);
      volume += static_cast<double>(measures.volume[m]);
      worst_stretch = std::max(worst_stretch, static_cast<double>(measures.length[m] / asset.muscles[m].rest_length));
    }
    muscles += asset.size();
  }
  if (muscles == 0) return;
  report.record("muscle.length_mean_m", length / static_cast<double>(muscles));
  report.record("muscle.length_ratio_max", worst_stretch);
  report.record("muscle.volume_total_m3", volume);
  const DetailCounts details = count_details();
  report.record("muscle.level_mean", details.mean_level);
  report.record("muscle.level_switches", static_cast<double>(details.switches));
  report.record("muscle.vertices", static_cast<double>(details.vertices));
  report.record("held_steps", static_cast<double>(held_steps()));
}

void add_legacy_collision(ecs::World& world, const SpawnedCharacter& character) {
  std::vector<muscle::LegacyBoneMesh> meshes;
  for (const muscle::BoneMesh& bone : character.asset->bone_meshes) {
    meshes.push_back({bone.bone, bone.transform, bone.mesh.get()});
  }
  muscle::add_legacy_collision(world, character.musculature,
                               muscle::make_legacy_bones(meshes, character.asset->skeleton->rest_world.size()));
}

}  // namespace fascicle::game
