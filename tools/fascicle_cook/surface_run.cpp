#include "tools/fascicle_cook/surface_run.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string_view>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "engine/animation/skeleton.hpp"
#include "engine/ecs/monotonic_clock.hpp"
#include "game/simulation.hpp"
#include "game/surface_figures.hpp"
#include "modules/muscle/asset/fibres/fibre_bundle.hpp"
#include "modules/muscle/components/surface_hull.hpp"
#include "modules/muscle/components/surface_muscle.hpp"
#include "tools/fascicle_cook/surface_revisit.hpp"
#include "tools/fascicle_cook/surface_switches.hpp"

namespace fascicle::cook {
namespace {

using namespace muscle;

constexpr double kNoNumber = std::numeric_limits<double>::quiet_NaN();

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

// Bones as the character has them, whatever the solver made of them.
std::vector<glm::mat4> bones_of(const ecs::World& world, const SurfaceMuscle& muscle) {
  const std::vector<glm::mat4>& now = world.get<BoneMatrices>(muscle.character).world;
  const auto frame = static_cast<std::size_t>(muscle.asset->frame_bone);
  const glm::dmat4 to_frame = glm::dmat4(muscle.rest_bones[frame]) * glm::inverse(glm::dmat4(now[frame]));
  std::vector<glm::mat4> bones;
  for (std::size_t b = 0; b < std::min(now.size(), muscle.rest_bones.size()); ++b) {
    bones.emplace_back(to_frame * glm::dmat4(now[b]) * glm::inverse(glm::dmat4(muscle.rest_bones[b])));
  }
  return bones;
}

SurfacePose pose_of(const ecs::World& world, const game::SurfaceFigures& figures) {
  SurfacePose pose{.bones = bones_of(world, world.get<SurfaceMuscle>(figures.entity)),
                   .shape = shape_of(*figures.asset, world.get<SurfaceState>(figures.entity)),
                   .residuals = {},
                   .refined = {}};
  if (!figures.hull || !figures.hull->posed) return pose;
  const HullScratch& scratch = world.get<SurfaceHull>(figures.entity).scratch;
  pose.residuals = scratch.residuals;
  pose.refined = scratch.refined;
  return pose;
}

double system_ms(game::Simulation& simulation, std::string_view system) {
  for (const ecs::SystemTiming& timing : simulation.schedule().timings()) {
    if (timing.name == system) return 1e-6 * static_cast<double>(timing.end_ns - timing.start_ns);
  }
  return 0.0;
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
  if (figures.hull && figures.hull->posed) {
    step.posed = 1.0;
    step.iterations = static_cast<double>(figures.hull->iterations);
    step.converged = figures.hull->converged ? 1.0 : 0.0;
    step.residual = figures.hull->residual;
  }
  return step;
}

}  // namespace

std::vector<glm::vec3> shape_of(const SurfaceAsset& asset, const SurfaceState& state) {
  std::vector<glm::vec3> shape;
  for (std::uint32_t v = 0; v < asset.vertex_count; ++v) {
    shape.emplace_back(state.points[v].x, state.points[v].y, state.points[v].z);
  }
  return shape;
}

SurfaceRun run_surfaces(const std::shared_ptr<const SceneAsset>& scene, const SurfaceRunOptions& options) {
  game::Simulation simulation(scene, simulation_options(options));
  ecs::World& world = simulation.world();
  switch_off(options, world);
  SurfaceRun run{.scene = scene->name, .simd = std::string(to_string(simulation.simd())), .options = options,
                 .step_hz = scene->step_hz, .muscles = {}};
  world.view<const SurfaceMuscle>().each([&](ecs::Entity entity, const SurfaceMuscle& muscle) {
    SurfaceMuscleRun& made = run.muscles.emplace_back();
    made.asset = muscle.asset;
    made.settings = muscle.settings;
    made.bones = bone_names(simulation, muscle);
    if (const auto* hull = world.try_get<SurfaceHull>(entity)) {
      made.hull_vertices = hull->asset->rest.size();
      made.hull = hull->settings;
    }
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
  std::vector<Coordinates> coordinates;
  for (std::uint64_t i = 0; i < run.options.frames; ++i) {
    const std::int64_t start = monotonic_ns();
    simulation.step();
    const double step_ms = 1e-6 * static_cast<double>(monotonic_ns() - start);
    const double pose_ms = system_ms(simulation, "pose_surface_muscles");
    coordinates.push_back(read_coordinates(simulation));
    if (options.solver == SolverSwitch::kFrozen) follow_frames(world);
    const std::vector<game::SurfaceFigures>& figures = meters.measure(simulation);
    for (std::size_t m = 0; m < std::min(figures.size(), run.muscles.size()); ++m) {
      run.muscles[m].steps.push_back(to_step(figures[m], step_ms));
      run.muscles[m].steps.back().pose_ms = pose_ms;
      if (figures[m].hull || options.keep_poses) run.muscles[m].poses.push_back(pose_of(world, figures[m]));
      if (i + 1 == kFlexedStep) {
        run.muscles[m].flexed = shape_of(*figures[m].asset, world.get<SurfaceState>(figures[m].entity));
      }
      const std::vector<double>& ratios = figures[m].fibre_ratios;
      run.muscles[m].fibre_ratios.resize(ratios.size());
      for (std::size_t f = 0; f < ratios.size(); ++f) run.muscles[m].fibre_ratios[f].push_back(ratios[f]);
    }
  }
  revisit(scene, coordinates, simulation, run);
  return run;
}

ShapeDifference compare_shapes(const SurfaceAsset& asset, const std::vector<glm::vec3>& one,
                               const std::vector<glm::vec3>& other) {
  ShapeDifference difference;
  const std::size_t count = one.size();
  if (other.size() != count) return {kNoNumber, kNoNumber};
  glm::dvec3 slid(0.0);
  for (std::size_t v = 0; v < count && asset.attached.empty(); ++v) {
    slid += (glm::dvec3(other[v]) - glm::dvec3(one[v])) / static_cast<double>(count);
  }
  for (std::size_t v = 0; v < count; ++v) {
    const double distance = glm::distance(glm::dvec3(one[v]) + slid, glm::dvec3(other[v]));
    difference.mean += distance / static_cast<double>(count);
    if (!(distance <= difference.largest)) difference.largest = distance;
    if (!std::isfinite(distance)) break;
  }
  const double size = asset.size > 0.0f ? static_cast<double>(asset.size) : 1.0;
  return {difference.largest / size, difference.mean / size};
}

}  // namespace fascicle::cook
