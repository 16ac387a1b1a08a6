#include "tools/fascicle_cook/surface_run.hpp"

#include <algorithm>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "engine/animation/skeleton.hpp"
#include "engine/ecs/monotonic_clock.hpp"
#include "game/simulation.hpp"
#include "game/surface_figures.hpp"
#include "modules/muscle/asset/fibres/fibre_bundle.hpp"
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

void apply(const SurfaceRunOptions& options, ecs::World& world) {
  world.view<SurfaceMuscle, SurfaceState>().each([&](SurfaceMuscle& muscle, SurfaceState& state) {
    muscle.settings.substeps *= options.substeps_times;
    state.enabled = options.solver == SurfaceSolver::kOn;
    // A muscle whose bones are not all there is left alone.
    if (options.solver == SurfaceSolver::kFrozen) muscle.rest_bones.emplace_back(1.0f);
    if (!options.volume) muscle.settings.volume_compliance = kNoStiffness;
    if (!options.bones) muscle.settings.collide_with_bones = false;
    if (!options.edges || !options.angles) muscle.asset = softened(*muscle.asset, options);
  });
}

// A frozen muscle still goes with its frame bone, as everything does that stands in the simulation's frame.
void follow_frames(ecs::World& world) {
  world.view<const SurfaceMuscle, SurfaceState>().each([&](const SurfaceMuscle& muscle, SurfaceState& state) {
    const auto bone = static_cast<std::size_t>(muscle.asset->frame_bone);
    const glm::dmat4 now{world.get<BoneMatrices>(muscle.character).world[bone]}, rest{muscle.rest_bones[bone]};
    state.frame = glm::mat4(now * glm::inverse(rest));
  });
}

// The name of each attachment's bone, of the character that the muscle belongs to.
std::vector<std::string> bone_names(const game::Simulation& simulation, const SurfaceMuscle& muscle) {
  std::vector<std::string> names;
  for (const game::SpawnedCharacter& character : simulation.characters()) {
    if (character.entity != muscle.character) continue;
    for (const SurfaceAttachmentAsset& attachment : muscle.asset->attachments) {
      names.push_back(attachment.bone < 0
                          ? std::string("-")
                          : character.asset->skeleton->names[static_cast<std::size_t>(attachment.bone)]);
    }
  }
  return names;
}

std::vector<glm::vec3> shape_of(const ecs::World& world, const game::SurfaceFigures& figures) {
  const SurfaceState& state = world.get<SurfaceState>(figures.entity);
  std::vector<glm::vec3> shape;
  for (std::uint32_t v = 0; v < figures.asset->vertex_count; ++v) {
    shape.emplace_back(state.points[v].x, state.points[v].y, state.points[v].z);
  }
  return shape;
}

SurfaceStepFigures to_step(const game::SurfaceFigures& figures, double step_ms) {
  const SurfaceQuality& q = *figures.quality;
  SurfaceStepFigures step;
  step.volume_ratio = q.volume_ratio;
  step.edge_mean = q.edge_ratio_mean;
  step.edge_abs_mean = q.edge_ratio_abs_mean;
  step.edge_min = q.edge_ratio_min;
  step.edge_max = q.edge_ratio_max;
  step.edge_p5 = q.edge_ratio_p5;
  step.edge_p50 = q.edge_ratio_p50;
  step.edge_p95 = q.edge_ratio_p95;
  step.dihedral_mean = q.dihedral_change_mean;
  step.dihedral_max = q.dihedral_change_max;
  step.angle_max = q.angle_max;
  step.folded = q.folded;
  step.turned = q.turned;
  step.rest_distance_max = 1e3 * q.rest_distance_max;
  step.attachment_error_max = 1e3 * figures.attachment_error;
  step.bone_depth_max = 1e3 * figures.depths.free.depth;
  step.bone_depth_beside = 1e3 * figures.depths.beside.depth;
  if (!figures.fibre_ratios.empty()) {
    const auto [least, most] = std::minmax_element(figures.fibre_ratios.begin(), figures.fibre_ratios.end());
    step.fibre_mean = figures.fibre_ratio_mean;
    step.fibre_min = *least;
    step.fibre_max = *most;
    step.fibres_outside = static_cast<double>(figures.fibres_outside.count);
    step.fibre_furthest = 1e3 * figures.fibres_outside.furthest;
  }
  step.fallbacks = static_cast<double>(figures.fallbacks);
  step.step_ms = step_ms;
  return step;
}

}  // namespace

SurfaceRun run_surfaces(const std::shared_ptr<const SceneAsset>& scene, const SurfaceRunOptions& options) {
  game::Simulation simulation(scene, {.workers = options.workers, .skin_meshes = false});
  ecs::World& world = simulation.world();
  apply(options, world);
  SurfaceRun run{.scene = scene->name, .simd = std::string(to_string(simulation.simd())), .options = options,
                 .step_hz = scene->step_hz, .muscles = {}};
  world.view<const SurfaceMuscle>().each([&](ecs::Entity entity, const SurfaceMuscle& muscle) {
    SurfaceMuscleRun& made = run.muscles.emplace_back();
    made.asset = muscle.asset;
    made.settings = muscle.settings;
    made.bones = bone_names(simulation, muscle);
    for (const SurfaceAttachmentAsset& attachment : muscle.asset->attachments) {
      if (!attachment.origin) made.attached_at_insertion += attachment.count;
    }
    const FibreBundle* bundle = world.try_get<FibreBundle>(entity);
    if (bundle == nullptr || bundle->asset == nullptr) return;
    for (const float rest : bundle->asset->rest_length) made.fibre_rest.push_back(1e3 * static_cast<double>(rest));
  });
  if (run.options.frames == 0) run.options.frames = static_cast<std::uint64_t>(std::max(scene->frames, 0));
  if (run.muscles.empty()) return run;

  game::SurfaceMeters meters;
  meters.start(simulation);
  for (std::uint64_t i = 0; i < run.options.frames; ++i) {
    const std::int64_t start = monotonic_ns();
    simulation.step();
    const double step_ms = 1e-6 * static_cast<double>(monotonic_ns() - start);
    if (options.solver == SurfaceSolver::kFrozen) follow_frames(world);
    const std::vector<game::SurfaceFigures>& figures = meters.measure(simulation);
    for (std::size_t m = 0; m < std::min(figures.size(), run.muscles.size()); ++m) {
      run.muscles[m].steps.push_back(to_step(figures[m], step_ms));
      if (i + 1 == kFlexedStep) run.muscles[m].flexed = shape_of(world, figures[m]);
      const std::vector<double>& ratios = figures[m].fibre_ratios;
      run.muscles[m].fibre_ratios.resize(ratios.size());
      for (std::size_t f = 0; f < ratios.size(); ++f) run.muscles[m].fibre_ratios[f].push_back(ratios[f]);
    }
  }
  return run;
}

ShapeDifference compare_flexed(const SurfaceMuscleRun& one, const SurfaceMuscleRun& other) {
  ShapeDifference difference;
  const std::size_t count = std::min(one.flexed.size(), other.flexed.size());
  glm::dvec3 slid(0.0);
  for (std::size_t v = 0; v < count && one.asset->attached.empty(); ++v) {
    slid += (glm::dvec3(other.flexed[v]) - glm::dvec3(one.flexed[v])) / static_cast<double>(count);
  }
  for (std::size_t v = 0; v < count; ++v) {
    const double distance = glm::distance(glm::dvec3(one.flexed[v]) + slid, glm::dvec3(other.flexed[v]));
    difference.largest = std::max(difference.largest, distance);
    difference.mean += distance / static_cast<double>(count);
  }
  const double size = one.asset->size > 0.0f ? static_cast<double>(one.asset->size) : 1.0;
  return {difference.largest / size, difference.mean / size};
}

}  // namespace fascicle::cook
