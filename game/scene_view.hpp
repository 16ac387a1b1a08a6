// What the player sees of a Simulation: it registers upload systems in the simulation's schedule, gives each character
// its things in the renderer (shared per asset), and keeps both in step when characters come and go.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string_view>
#include <vector>

#include "engine/animation/skeleton.hpp"
#include "engine/animation/skinning.hpp"
#include "engine/ecs/resource.hpp"
#include "engine/ecs/view.hpp"
#include "engine/render/renderer.hpp"
#include "game/simulation.hpp"
#include "modules/muscle/systems/5_present/draw_collision.hpp"
#include "modules/muscle/systems/5_present/draw_muscles.hpp"
#include "modules/muscle/systems/5_present/draw_surface_muscles.hpp"

namespace fascicle::game {

// On a character's entity: its bone meshes.
struct DrawnBones {
  RigidHandle group;
  std::vector<std::int32_t> bones;       // one a mesh
  std::vector<glm::mat4> transforms;     // mesh to its bone's frame
  std::uint32_t teleport_count = 0;
};

// On a skin's entity.
struct DrawnSkin {
  SkinHandle skin;
  ecs::Entity character;
  std::uint32_t teleport_count = 0;
};

void upload_bones(ecs::View<const BoneMatrices, DrawnBones> characters,
                  ecs::Resource<const muscle::DrawTarget> target);
void upload_skins(ecs::View<const SkinnedSurface, DrawnSkin> skins, ecs::View<const BoneMatrices> characters,
                  ecs::Resource<const muscle::DrawTarget> target);

// Where the scene's camera looks from.
OrbitCamera scene_camera(const muscle::SceneAsset& scene);

// What a camera sees of the muscles in a picture of `height` pixels; `level` is the one asked for, if any.
muscle::Viewer make_viewer(const OrbitCamera& camera, int height, std::optional<std::uint32_t> level);

class SceneView {
 public:
  // Adds the upload systems to the simulation's schedule and gives all its characters their pictures.
  SceneView(Simulation& simulation, Renderer& renderer);
  SceneView(const SceneView&) = delete;
  SceneView& operator=(const SceneView&) = delete;

  // Before each of the simulation's steps, on the GL thread.
  void begin_step() { renderer_.begin_step(); }

  // Around Simulation::swap_scene: everything drawn goes, then comes back for the new characters.
  void release();
  void attach();

  // Into the next picture only: what collision does on all characters, as it is after the last step.
  void mark_collision();
  // The section and vertex that a tag names, on one of Simulation::characters().
  void mark_place(std::size_t character, const muscle::SectionTag& tag, std::uint32_t colour);

  // Of one muscle, on all characters of its asset, at every level of detail: hidden or highlighted. What a
  // surface muscle stands for (CharacterAsset::hidden_muscles) stays hidden.
  void set_muscle_flags(std::size_t scene_index, std::uint32_t muscle, std::uint32_t flags);
  // Likewise of a surface muscle, by its name.
  void set_surface_flags(std::size_t scene_index, std::string_view name, std::uint32_t flags);

 private:
  struct SharedMuscles {
    StripTopologyHandle topology;
    std::vector<std::uint32_t> line_indices;
  };

  void attach_character(const SpawnedCharacter& character);
  void attach_surfaces();
  void release_surfaces();
  void apply_flags(const SpawnedCharacter& character, std::uint32_t muscle, std::uint32_t flags);
  muscle::DrawnMuscles::Level add_level(const muscle::MuscleAsset& asset);

  Simulation& simulation_;
  Renderer& renderer_;
  // Keyed by address for lookup only; handles are released in the order in which they were made.
  std::map<const muscle::MuscleAsset*, SharedMuscles> muscles_;
  std::map<const TriangleMesh*, MeshHandle> meshes_;
  std::vector<StripTopologyHandle> topologies_;
  std::vector<MeshHandle> mesh_order_;
  muscle::CollisionMarks marks_;
};

}  // namespace fascicle::game
