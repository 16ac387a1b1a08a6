#include "tools/fascicle_cook/surface_switches.hpp"

#include <glm/matrix.hpp>

#include "engine/animation/skeleton.hpp"
#include "engine/content/triangle_mesh.hpp"
#include "engine/ecs/world.hpp"
#include "modules/muscle/asset/hull/hull_asset.hpp"
#include "modules/muscle/components/surface_muscle.hpp"

namespace fascicle::cook {
namespace {

using namespace muscle;

// So soft that it has no effect within any run.
constexpr float kNoStiffness = 1.0e12f;
// The muscle's own asset with edges or angles that hold nothing.
std::shared_ptr<const SurfaceAsset> softened(const SurfaceAsset& asset, const SurfaceRunOptions& options) {
  auto soft = std::make_shared<SurfaceAsset>(asset);
  for (HingePack& pack : soft->packs) {
    if (!options.edges) pack.stretch_compliance.fill(kNoStiffness);
    if (!options.angles) pack.bend_compliance.fill(kNoStiffness);
  }
  return soft;
}

// The hull that the character has, reduced anew.
Result<std::shared_ptr<const HullAsset>> weaker_hull(const CharacterAsset& character, std::size_t muscle,
                                                     const SurfaceRunOptions& options) {
  const HullAsset& hull = *character.hulls[muscle];
  SurfaceMuscleDescription description = character.surface_descriptions[muscle];
  if (!options.angles) description.hull.bending = 0.0f;
  if (!options.direction) description.hull.direction = 0.0f;
  TriangleMesh mesh;
  mesh.positions = hull.rest;
  mesh.indices = hull.triangles;
  return build_hull_asset(*character.surface_muscles[muscle], description, mesh, character.muscles.get());
}

}  // namespace

Result<std::shared_ptr<const SceneAsset>> without_parts(const std::shared_ptr<const SceneAsset>& scene,
                                                        const SurfaceRunOptions& options) {
  if (options.angles && options.direction) return scene;
  auto changed = std::make_shared<SceneAsset>(*scene);
  for (SceneCharacter& placed : changed->characters) {
    auto character = std::make_shared<CharacterAsset>(*placed.character);
    for (std::size_t i = 0; i < character->hulls.size(); ++i) {
      if (character->hulls[i] == nullptr) continue;
      auto hull = weaker_hull(*character, i, options);
      if (!hull) return hull.diagnostics();
      character->hulls[i] = *hull;
    }
    placed.character = std::move(character);
  }
  return std::shared_ptr<const SceneAsset>(std::move(changed));
}

game::SimulationOptions simulation_options(const SurfaceRunOptions& options) {
  game::SimulationOptions simulation{.workers = options.workers, .skin_meshes = false};
  simulation.surface_solver = options.forced;
  return simulation;
}

void switch_off(const SurfaceRunOptions& options, ecs::World& world) {
  world.view<SurfaceMuscle, SurfaceState>().each([&](SurfaceMuscle& muscle, SurfaceState& state) {
    muscle.settings.substeps *= options.substeps_times;
    state.enabled = options.solver == SolverSwitch::kOn;
    // A muscle whose bones are not all there is left alone.
    if (options.solver == SolverSwitch::kFrozen) muscle.rest_bones.emplace_back(1.0f);
    if (!options.volume) muscle.settings.volume_compliance = kNoStiffness;
    if (!options.bones) muscle.settings.collide_with_bones = false;
    if (!options.edges || !options.angles) muscle.asset = softened(*muscle.asset, options);
  });
}

void follow_frames(ecs::World& world) {
  world.view<const SurfaceMuscle, SurfaceState>().each([&](const SurfaceMuscle& muscle, SurfaceState& state) {
    const auto bone = static_cast<std::size_t>(muscle.asset->frame_bone);
    const glm::dmat4 now{world.get<BoneMatrices>(muscle.character).world[bone]}, rest{muscle.rest_bones[bone]};
    state.frame = glm::mat4(now * glm::inverse(rest));
  });
}

}  // namespace fascicle::cook
