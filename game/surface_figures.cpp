#include "game/surface_figures.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/animation/skeleton.hpp"
#include "modules/muscle/asset/fibres/fibre_bundle.hpp"
#include "modules/muscle/components/surface_hull.hpp"
#include "modules/muscle/components/surface_muscle.hpp"
#include "modules/muscle/kernels/surface/measure_quality.hpp"

namespace fascicle::game {
namespace {

std::vector<ecs::Entity> surface_muscles(const ecs::World& world) {
  std::vector<ecs::Entity> entities;
  world.view<const muscle::SurfaceMuscle>().each(
      [&](ecs::Entity entity, const muscle::SurfaceMuscle&) { entities.push_back(entity); });
  return entities;
}

std::shared_ptr<const muscle::CharacterAsset> character_of(const Simulation& simulation, ecs::Entity entity) {
  for (const SpawnedCharacter& character : simulation.characters()) {
    if (character.entity == entity) return character.asset;
  }
  return nullptr;
}

void read_fibres(const muscle::FibreBundle& bundle, SurfaceFigures& figures) {
  if (bundle.asset == nullptr) return;
  double sum = 0.0;
  for (std::size_t f = 0; f < std::min(bundle.length.size(), bundle.asset->rest_length.size()); ++f) {
    const double rest = static_cast<double>(bundle.asset->rest_length[f]);
    figures.fibre_ratios.push_back(rest > 0.0 ? static_cast<double>(bundle.length[f]) / rest : 1.0);
    sum += figures.fibre_ratios.back();
  }
  if (!figures.fibre_ratios.empty()) {
    figures.fibre_ratio_mean = sum / static_cast<double>(figures.fibre_ratios.size());
  }
}

HullFigures read_hull(const muscle::SurfaceHull& hull) {
  HullFigures figures;
  figures.posed = hull.solver == muscle::SurfaceSolver::kCoarseHull;
  figures.converged = hull.pose.converged;
  figures.iterations = hull.pose.iterations;
  const std::vector<float>& residuals = hull.scratch.residuals;
  figures.residual = residuals.empty() ? std::numeric_limits<double>::quiet_NaN()
                                       : static_cast<double>(residuals.back());
  return figures;
}

// The one further from 1.
double further(double a, double b) { return std::abs(a - 1.0) > std::abs(b - 1.0) ? a : b; }

}  // namespace

SurfaceMeters::Meter& SurfaceMeters::meter_of(const std::shared_ptr<const muscle::CharacterAsset>& character,
                                              const std::shared_ptr<const muscle::SurfaceAsset>& asset) {
  for (Meter& meter : meters_) {
    if (meter.asset == asset && meter.character == character) return meter;
  }
  auto known = std::find_if(characters_.begin(), characters_.end(),
                            [&](const Character& c) { return c.asset == character; });
  if (known == characters_.end()) {
    characters_.push_back({character, muscle::make_bone_solids(character->bone_meshes)});
    known = std::prev(characters_.end());
  }
  return meters_.emplace_back(Meter{asset, character, {asset, known->bones}, muscle::InsideMeter(asset)});
}

void SurfaceMeters::start(Simulation& simulation) {
  ecs::World& world = simulation.world();
  for (const ecs::Entity entity : surface_muscles(world)) {
    if (!world.has<muscle::SurfaceQuality>(entity)) world.add(entity, muscle::SurfaceQuality{});
  }
}

const std::vector<SurfaceFigures>& SurfaceMeters::measure(Simulation& simulation) {
  ecs::World& world = simulation.world();
  figures_.clear();
  for (const ecs::Entity entity : surface_muscles(world)) {
    const auto& own = world.get<muscle::SurfaceMuscle>(entity);
    const auto& state = world.get<muscle::SurfaceState>(entity);
    const auto character = character_of(simulation, own.character);
    if (character == nullptr || state.points.size() < own.asset->vertex_count) continue;
    if (!world.has<muscle::SurfaceQuality>(entity)) {
      muscle::measure_quality(*own.asset, state.points, state.bones, world.add(entity, muscle::SurfaceQuality{}));
    }
    SurfaceFigures figures;
    figures.entity = entity;
    figures.asset = own.asset;
    figures.fallbacks = state.fallbacks;
    const std::vector<glm::mat4>& bones = world.get<BoneMatrices>(own.character).world;
    const auto* bundle = world.try_get<muscle::FibreBundle>(entity);
    simulation.workers().execute([&] {
      Meter& meter = meter_of(character, own.asset);
      figures.depths = meter.depths.measure(state.points, state.frame, bones);
      if (bundle != nullptr && figures.depths.finite) {
        figures.fibres_outside = meter.inside.measure(state.points, bundle->points);
      }
    });
    figures.attachment_errors = muscle::attachment_errors(*own.asset, state.points, state.frame,
                                                          character->skeleton->rest_world, bones);
    for (const double error : figures.attachment_errors) {
      figures.attachment_error = std::max(figures.attachment_error, error);
    }
    if (bundle != nullptr) read_fibres(*bundle, figures);
    if (const auto* hull = world.try_get<muscle::SurfaceHull>(entity)) figures.hull = read_hull(*hull);
    figures_.push_back(std::move(figures));
  }
  for (SurfaceFigures& figures : figures_) {
    // Adding a component may have moved the others.
    auto& quality = world.get<muscle::SurfaceQuality>(figures.entity);
    if (figures.hull && figures.hull->posed) quality.angles.clear();
    figures.quality = &quality;
  }
  return figures_;
}

namespace {

void record_hulls(const std::vector<SurfaceFigures>& figures, Report& report) {
  bool any_hull = false, any_posed = false, converged = true;
  double iterations = 0.0, residual = 0.0;
  for (const SurfaceFigures& f : figures) {
    any_hull |= f.hull.has_value();
    if (!f.hull || !f.hull->posed) continue;
    any_posed = true;
    converged &= f.hull->converged;
    iterations = std::max(iterations, static_cast<double>(f.hull->iterations));
    if (!std::isnan(residual) && !(f.hull->residual <= residual)) residual = f.hull->residual;
  }
  if (!any_hull) return;
  const auto record = [&](const char* name, double value) {
    report.record(name, any_posed ? value : std::numeric_limits<double>::quiet_NaN());
  };
  record("surface.iterations", iterations);
  record("surface.residual", residual);
  record("surface.converged", converged ? 1.0 : 0.0);
}

}  // namespace

void record_surface_figures(const std::vector<SurfaceFigures>& figures, Report& report) {
  if (figures.empty()) return;
  double volume = 1.0, mean = 1.0, most = 0.0, off = 0.0, bent = 0.0, rest = 0.0, depth = 0.0, attachment = 0.0;
  double fibres = 1.0, outside = 0.0, turned = 0.0, fallbacks = 0.0;
  bool any_fibres = false;
  for (const SurfaceFigures& f : figures) {
    volume = further(f.quality->volume_ratio, volume);
    mean = further(f.quality->edge_ratio_mean, mean);
    most = std::max(most, f.quality->edge_ratio_max);
    off = std::max(off, f.quality->edge_ratio_abs_mean);
    bent = std::max(bent, f.quality->dihedral_change_mean);
    rest = std::max(rest, f.quality->rest_distance_max);
    depth = std::max(depth, f.depths.free.depth);
    attachment = std::max(attachment, f.attachment_error);
    turned += static_cast<double>(f.quality->turned);
    fallbacks += static_cast<double>(f.fallbacks);
    if (f.fibre_ratios.empty()) continue;
    any_fibres = true;
    fibres = further(f.fibre_ratio_mean, fibres);
    outside += static_cast<double>(f.fibres_outside.count);
  }
  report.record("surface.volume_ratio", volume);
  report.record("surface.edge_ratio_mean", mean);
  report.record("surface.edge_ratio_max", most);
  report.record("surface.edge_ratio_abs_mean", off);
  report.record("surface.dihedral_change_mean_rad", bent);
  report.record("surface.bone_depth_max_mm", 1e3 * depth);
  report.record("surface.rest_distance_max_mm", 1e3 * rest);
  report.record("surface.attachment_error_max_mm", 1e3 * attachment);
  // Null where no muscle has fibres.
  report.record("surface.fibre_length_ratio_mean", any_fibres ? fibres : std::numeric_limits<double>::quiet_NaN());
  if (any_fibres) report.record("surface.fibre_points_outside", outside);
  report.record("surface.turned_edges", turned);
  report.record("surface.fallbacks", fallbacks);
  record_hulls(figures, report);
}

}  // namespace fascicle::game
