#include "tools/fascicle_cook/level_sweep.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>

#include <fmt/format.h>

#include "engine/animation/skeleton.hpp"
#include "modules/muscle/asset/fit/fit_muscles.hpp"
#include "tools/fascicle_cook/mesh_groups.hpp"

namespace fascicle::cook {
namespace {

using namespace fascicle::muscle;

constexpr double kMm = 1000.0;
constexpr std::array<std::uint32_t, 7> kSectionVertices{6, 8, 10, 12, 18, 24, 36};
constexpr std::array<std::uint32_t, 4> kSubdivisions{0, 1, 2, 3};

SweptLevel sweep_level(const CharacterAsset& character, const std::vector<MeshGroup>& groups, std::uint32_t section_vertices,
                       std::uint32_t subdivision) {
  std::vector<MuscleDescription> descriptions = character.descriptions;
  std::vector<FitInput> inputs(descriptions.size());
  for (std::size_t i = 0; i < descriptions.size(); ++i) {
    descriptions[i].section_vertices = section_vertices;
    descriptions[i].longitudinal_subdivision = subdivision;
    inputs[i].description = &descriptions[i];
  }
  for (const MeshGroup& group : groups) {
    for (const std::uint32_t i : group.muscles) inputs[i].mesh = group.mesh;
  }
  std::vector<MuscleFit> fits;
  for (FittedMuscle& muscle : fit_muscles(inputs, character.skeleton->rest_world)) fits.push_back(std::move(muscle.fit));
  const auto asset = build_muscle_asset(descriptions, character.skeleton->rest_world, fits);
  SweptLevel level{section_vertices, subdivision, {}, {}};
  if (!asset) return level;
  std::vector<bool> fitted(fits.size());
  for (std::size_t i = 0; i < fits.size(); ++i) fitted[i] = !fits[i].radii.empty();
  const std::vector<FitComparison> compared = compare_groups(groups, **asset, fitted);
  for (std::size_t i = 0; i < descriptions.size(); ++i) {
    if (!fitted[i]) continue;
    level.muscles.push_back(i);
    level.comparisons.push_back(compared[i]);
  }
  return level;
}

double rms_over(const std::vector<FitComparison>& all, SurfaceDistance FitComparison::*way) {
  double squares = 0.0;
  for (const FitComparison& one : all) squares += (one.*way).rms * (one.*way).rms;
  return all.empty() ? 0.0 : std::sqrt(squares / static_cast<double>(all.size()));
}

double max_over(const std::vector<FitComparison>& all, SurfaceDistance FitComparison::*way) {
  double most = 0.0;
  for (const FitComparison& one : all) most = std::max(most, (one.*way).max);
  return most;
}

}  // namespace

std::vector<SweptLevel> sweep_levels(const CharacterAsset& character) {
  const std::vector<MeshGroup> groups = group_by_mesh(character);
  std::vector<SweptLevel> levels;
  for (const std::uint32_t subdivision : kSubdivisions) {
    for (const std::uint32_t section_vertices : kSectionVertices) {
      levels.push_back(sweep_level(character, groups, section_vertices, subdivision));
    }
  }
  return levels;
}

std::string to_table(const std::vector<SweptLevel>& levels) {
  std::string out = fmt::format("{:>5}{:>5}{:>10}{:>8}{:>9}{:>14}{:>8}{:>14}{:>8}\n", "LSS", "|C|", "vertices", "fewer",
                                "outside", "fit>mesh rms", "max", "mesh>fit rms", "max");
  for (const SweptLevel& level : levels) {
    std::size_t vertices = 0, of_mesh = 0, outside = 0;
    for (const FitComparison& compared : level.comparisons) {
      vertices += compared.fit_vertices;
      of_mesh += compared.mesh_vertices;
      outside += compared.sections_outside;
    }
    const double fewer = of_mesh == 0 ? 0.0 : 100.0 - 100.0 * static_cast<double>(vertices) / static_cast<double>(of_mesh);
    fmt::format_to(std::back_inserter(out), "{:>5}{:>5}{:>10}{:>7.0f}%{:>9}{:>14.3f}{:>8.2f}{:>14.3f}{:>8.2f}\n",
                   level.longitudinal_subdivision, level.section_vertices, vertices, fewer, outside,
                   kMm * rms_over(level.comparisons, &FitComparison::fit_to_mesh),
                   kMm * max_over(level.comparisons, &FitComparison::fit_to_mesh),
                   kMm * rms_over(level.comparisons, &FitComparison::mesh_to_fit),
                   kMm * max_over(level.comparisons, &FitComparison::mesh_to_fit));
  }
  out += "Distances in mm, from the fitted surface to the mesh and back, over all muscles; fewer: vertices than the meshes'.\n";
  return out;
}

std::string to_csv(const std::vector<SweptLevel>& levels, const CharacterAsset& character) {
  std::string out =
      "muscle,longitudinal_subdivision,section_vertices,vertices,mesh_vertices,sections,sections_outside,"
      "fit_to_mesh_rms_m,fit_to_mesh_max_m,mesh_to_fit_rms_m,mesh_to_fit_max_m,volume_m3,mesh_volume_m3\n";
  for (const SweptLevel& level : levels) {
    for (std::size_t k = 0; k < level.muscles.size(); ++k) {
      const FitComparison& c = level.comparisons[k];
      fmt::format_to(std::back_inserter(out), "{},{},{},{},{},{},{},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g}\n",
                     character.descriptions[level.muscles[k]].name, level.longitudinal_subdivision,
                     level.section_vertices, c.fit_vertices, c.mesh_vertices, c.sections, c.sections_outside,
                     c.fit_to_mesh.rms, c.fit_to_mesh.max, c.mesh_to_fit.rms, c.mesh_to_fit.max, c.fit_volume,
                     c.mesh_volume);
    }
  }
  return out;
}

}  // namespace fascicle::cook
