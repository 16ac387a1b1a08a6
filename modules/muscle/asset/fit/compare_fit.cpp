#include "modules/muscle/asset/fit/compare_fit.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "engine/geometry/mesh_measures.hpp"

namespace fascicle::muscle {
namespace {

constexpr double kSamples = 2000.0;

double spacing_for(double area, double spacing) { return spacing > 0.0 ? spacing : std::sqrt(area / kSamples); }

std::uint32_t count_used_vertices(const TriangleMesh& mesh) {
  std::vector<char> used(mesh.positions.size(), 0);
  for (const std::uint32_t index : mesh.indices) used[index] = 1;
  return static_cast<std::uint32_t>(std::ranges::count(used, 1));
}

// What does not need the surface.
FitComparison count_sections(const MuscleAsset& asset, std::uint32_t muscle, const MeshOracle& oracle) {
  FitComparison result;
  result.mesh_volume = oracle.volume;
  result.mesh_vertices = oracle.vertices;
  result.sections = asset.muscles[muscle].section_count;
  for (std::uint32_t k = 0; k < result.sections; ++k) {
    result.sections_outside += oracle.winding.inside(rest_point(asset, muscle, k)) ? 0 : 1;
  }
  return result;
}

}  // namespace

MeshOracle::MeshOracle(TriangleMesh anatomical)
    : mesh(std::move(anatomical)),
      surface(mesh),
      winding(mesh),
      area(mesh_area(mesh)),
      volume(mesh_volume(mesh)),
      diagonal(double{mesh_bounds(mesh).diagonal()}),
      vertices(count_used_vertices(mesh)) {}

double FitComparison::rms() const {
  return std::sqrt(0.5 * (fit_to_mesh.rms * fit_to_mesh.rms + mesh_to_fit.rms * mesh_to_fit.rms));
}

double FitComparison::max() const { return std::max(fit_to_mesh.max, mesh_to_fit.max); }

TriangleMesh rest_surface(const MuscleAsset& asset, std::uint32_t muscle) {
  const MuscleLayout& layout = asset.muscles[muscle];
  const std::uint32_t around = layout.section_vertices, sections = layout.section_count;
  const Circle& circle = asset.circles[layout.circle];
  TriangleMesh mesh;
  mesh.name = layout.name;
  mesh.positions.reserve(std::size_t{sections} * around + 2);
  for (std::uint32_t k = 0; k < sections; ++k) {
    const std::uint32_t slot = asset.slot(muscle, k);
    const glm::vec3 centre = rest_point(asset, muscle, k);
    const glm::vec3 u(asset.rest_ux[slot], asset.rest_uy[slot], asset.rest_uz[slot]);
    const glm::vec3 v(asset.rest_vx[slot], asset.rest_vy[slot], asset.rest_vz[slot]);
    for (std::uint32_t i = 0; i < around; ++i) {
      const float radius = asset.rest_radii[asset.radius(muscle, k) + i];
      mesh.positions.push_back(centre + radius * (circle.cosines[i] * u + circle.sines[i] * v));
    }
  }
  mesh.positions.push_back(rest_point(asset, muscle, 0));
  mesh.positions.push_back(rest_point(asset, muscle, sections - 1));

  const std::uint32_t origin = sections * around, insertion = origin + 1, last_row = (sections - 1) * around;
  mesh.indices.reserve(std::size_t{6} * sections * around);
  for (std::uint32_t i = 0; i < around; ++i) {
    const std::uint32_t next = (i + 1) % around;
    for (std::uint32_t row = 0; row < last_row; row += around) {
      const std::uint32_t here = row + i, beside = row + next;
      mesh.indices.insert(mesh.indices.end(),
                          {here, beside, beside + around, here, beside + around, here + around});
    }
    mesh.indices.insert(mesh.indices.end(), {origin, next, i, insertion, last_row + i, last_row + next});
  }
  return mesh;
}

FitComparison compare_fit(const MuscleAsset& asset, std::uint32_t muscle, const MeshOracle& oracle, double spacing) {
  FitComparison result = count_sections(asset, muscle, oracle);
  const TriangleMesh fitted = rest_surface(asset, muscle);
  result.fit_vertices = static_cast<std::uint32_t>(fitted.positions.size());
  result.fit_volume = mesh_volume(fitted);
  result.fit_to_mesh = measure_distance(fitted, oracle.surface, spacing_for(mesh_area(fitted), spacing));
  result.mesh_to_fit = measure_distance(oracle.mesh, ClosestPoints(fitted), spacing_for(oracle.area, spacing));
  return result;
}

std::vector<FitComparison> compare_heads(const MuscleAsset& asset, std::span<const std::uint32_t> heads,
                                         const MeshOracle& oracle, double spacing) {
  if (heads.size() == 1) return {compare_fit(asset, heads[0], oracle, spacing)};
  struct Head {
    TriangleMesh mesh;
    WindingField winding;
    std::uint32_t first_triangle;  // in the heads' joined mesh
  };
  std::vector<Head> parts;
  TriangleMesh joined;
  for (const std::uint32_t muscle : heads) {
    TriangleMesh mesh = rest_surface(asset, muscle);
    WindingField winding(mesh);
    const auto first_vertex = static_cast<std::uint32_t>(joined.positions.size());
    const auto first_triangle = static_cast<std::uint32_t>(joined.indices.size() / 3);
    joined.positions.insert(joined.positions.end(), mesh.positions.begin(), mesh.positions.end());
    for (const std::uint32_t index : mesh.indices) joined.indices.push_back(first_vertex + index);
    parts.push_back({std::move(mesh), std::move(winding), first_triangle});
  }
  const ClosestPoints all(joined);

  std::vector<FitComparison> results;
  for (std::size_t h = 0; h < heads.size(); ++h) {
    const Head& head = parts[h];
    FitComparison result = count_sections(asset, heads[h], oracle);
    result.fit_vertices = static_cast<std::uint32_t>(head.mesh.positions.size());
    result.fit_volume = mesh_volume(head.mesh);
    const auto bounds_union = [&](const glm::vec3& p) {
      for (std::size_t other = 0; other < parts.size(); ++other) {
        if (other != h && parts[other].winding.inside(p)) return false;
      }
      return true;
    };
    result.fit_to_mesh =
        measure_distance(head.mesh, oracle.surface, spacing_for(mesh_area(head.mesh), spacing), bounds_union);
    const std::size_t end = h + 1 < parts.size() ? parts[h + 1].first_triangle : joined.indices.size() / 3;
    const auto is_nearest = [&](const glm::vec3& p) {
      const std::uint32_t triangle = all.at(p).triangle;
      return triangle >= head.first_triangle && triangle < end;
    };
    result.mesh_to_fit = measure_distance(oracle.mesh, all, spacing_for(oracle.area, spacing), is_nearest);
    results.push_back(result);
  }
  return results;
}

}  // namespace fascicle::muscle
