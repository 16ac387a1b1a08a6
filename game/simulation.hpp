// A running scene without a picture: the world, the schedule and the step. Used by the game in a window and headless,
// by tests and by benchmarks. Everything that happens in a step is a system in the schedule.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "engine/ecs/schedule.hpp"
#include "engine/ecs/world.hpp"
#include "engine/loop/frame_loop.hpp"
#include "engine/math/simd_level.hpp"
#include "engine/parallel/worker_arena.hpp"
#include "game/report.hpp"
#include "modules/muscle/asset/surface/surface_description.hpp"
#include "modules/muscle/components/muscle_detail.hpp"
#include "modules/muscle/content/scene_asset.hpp"

namespace fascicle::game {

struct SimulationOptions {
  int workers = 0;                       // 0: one for each core
  int copies = 1;                        // how often the scene's characters are spawned, on a grid
  SimdLevel simd = detect_simd();
  bool collision = true;                 // of muscles with bones and each other
  // Of all surface muscles that have a coarse hull; absent: as their levels of detail say.
  std::optional<muscle::SurfaceSolver> surface_solver = std::nullopt;
  bool skin_meshes = true;               // off where nobody sees the skin
};

// One character in the world and the entities that belong to it.
struct SpawnedCharacter {
  std::shared_ptr<const muscle::CharacterAsset> asset;
  std::size_t scene_index = 0;           // which of the scene's characters it is (a copy of)
  ecs::Entity entity;                    // LocalPose, Placement, BoneMatrices and a player
  ecs::Entity musculature;               // kNoEntity where the character has no muscles
  std::vector<ecs::Entity> surfaces = {};  // SurfaceMuscle each, in the order of CharacterAsset::surface_muscles
  std::vector<ecs::Entity> skins;        // SkinInstance, SkinnedSurface
};

class Simulation {
 public:
  Simulation(std::shared_ptr<const muscle::SceneAsset> scene, const SimulationOptions& options);

  // For systems that come after the simulation's own (drawing). Before the first step.
  ecs::Schedule& schedule() { return schedule_; }
  ecs::World& world() { return world_; }
  const ecs::World& world() const { return world_; }
  parallel::WorkerArena& workers() { return workers_; }
  const muscle::SceneAsset& scene() const { return *scene_; }
  const std::vector<SpawnedCharacter>& characters() const { return characters_; }

  // When steps are due (a window asks it each frame; headless steps without asking).
  FrameLoop& loop() { return loop_; }

  // Who looks at the muscles from the next step on; nobody at first, and all are at their finest.
  void set_viewer(const muscle::Viewer& viewer) { world_.resource<muscle::Viewer>() = viewer; }

  // One step of the scene's length.
  void step();
  std::uint64_t steps() const { return steps_; }
  SimdLevel simd() const { return options_.simd; }
  std::uint64_t clamped_steps() const { return loop_.clamped_steps(); }

  // Replaces the scene by a newer version of itself, between two steps. Characters that are still there go on from
  // where their animation is; what the systems derive is spawned anew and evaluated, so that the state is that of a
  // fresh start. Callers that hold entities (drawing) must let go of them before, look at characters() afterwards, and
  // call refresh once their own things stand, if their systems are to see the new characters before the next step.
  void swap_scene(std::shared_ptr<const muscle::SceneAsset> scene);

  // Runs all systems again at the same moment: a step of no length, which is not counted.
  void refresh();

  // How far the first character has moved over the ground since its start, m: what a camera follows.
  glm::vec3 travel() const;

  // A 64-bit hash of bone matrices, muscles' state and surfaces, and surface muscles' state.
  std::uint64_t hash() const;

  // How often a character kept its last bones, or a muscle its last shape, because the new ones were not finite.
  std::uint64_t held_steps() const;

  // Muscles' levels of detail: the mean over the characters that have muscles, parts of a level for their morphs; how
  // often a character's level was exchanged since it was spawned; vertices of all surfaces.
  struct DetailCounts {
    std::vector<std::size_t> characters;  // by level
    double mean_level = 0.0;
    std::uint64_t switches = 0, vertices = 0;
  };
  DetailCounts count_details() const;

  // This step's metrics of every part of the simulation, by name.
  void record_metrics(Report& report) const;

 private:
  void spawn_all();
  SpawnedCharacter spawn(std::size_t scene_index, int copy);
  void spawn_surfaces(SpawnedCharacter& spawned);
  void despawn_all();
  glm::vec3 root_position() const;

  std::shared_ptr<const muscle::SceneAsset> scene_;
  SimulationOptions options_;
  parallel::WorkerArena workers_;
  ecs::World world_;
  ecs::Schedule schedule_;
  std::vector<SpawnedCharacter> characters_;
  FrameLoop loop_;
  std::uint64_t steps_ = 0;
  glm::vec3 start_{0.0f};  // of the first character's moving root, at its first step
};

// Lets a character's muscles respond to collisions in the thesis's way while their settings' mode is kLegacy.
void add_legacy_collision(ecs::World& world, const SpawnedCharacter& character);

}  // namespace fascicle::game
