#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "engine/geometry/mesh_edges.hpp"
#include "engine/geometry/mesh_measures.hpp"
#include "modules/muscle/asset/muscle_asset.hpp"
#include "modules/muscle/asset/surface/carry_weights.hpp"
#include "modules/muscle/asset/surface/check_surface.hpp"
#include "modules/muscle/asset/surface/fibre_directions.hpp"
#include "modules/muscle/asset/surface/pack_hinges.hpp"
#include "modules/muscle/asset/surface/surface_asset.hpp"
#include "modules/muscle/asset/surface/surface_tree.hpp"
#include "modules/muscle/kernels/surface/surface_kernels.hpp"

namespace fascicle::muscle {
namespace {

// Interleaves the bits of a place's three coordinates in the box, 10 of each: near numbers are near places.
std::uint32_t morton(const glm::vec3& p, const Bounds& box) {
  const glm::vec3 extent = glm::max(box.upper - box.lower, glm::vec3(1.0e-9f));
  std::uint32_t code = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const auto cell = static_cast<std::uint32_t>(glm::clamp((p[axis] - box.lower[axis]) / extent[axis], 0.0f, 1.0f) * 1023.0f);
    for (std::uint32_t bit = 0; bit < 10; ++bit) code |= ((cell >> bit) & 1u) << (3 * bit + static_cast<std::uint32_t>(axis));
  }
  return code;
}

// The mesh with its vertices sorted by place; those that no triangle has are left out.
struct SortedMesh {
  TriangleMesh mesh;
  std::vector<std::uint32_t> file_vertex;   // by new number
  std::vector<std::uint32_t> vertex_of;     // by the file's number; kUnused
};
constexpr std::uint32_t kUnused = 0xffffffffu;

SortedMesh sort_by_place(const TriangleMesh& mesh) {
  SortedMesh sorted;
  sorted.vertex_of.assign(mesh.positions.size(), kUnused);
  std::vector<std::uint8_t> used(mesh.positions.size(), 0);
  for (const std::uint32_t v : mesh.indices) used[v] = 1;
  for (std::uint32_t v = 0; v < mesh.positions.size(); ++v) {
    if (used[v] != 0) sorted.file_vertex.push_back(v);
  }
  const Bounds box = mesh_bounds(mesh);
  std::stable_sort(sorted.file_vertex.begin(), sorted.file_vertex.end(), [&](std::uint32_t a, std::uint32_t b) {
    return morton(mesh.positions[a], box) < morton(mesh.positions[b], box);
  });
  for (std::uint32_t v = 0; v < sorted.file_vertex.size(); ++v) sorted.vertex_of[sorted.file_vertex[v]] = v;
  for (const std::uint32_t v : sorted.file_vertex) sorted.mesh.positions.push_back(mesh.positions[v]);

  // Triangles by their lowest vertex, too.
  std::vector<std::array<std::uint32_t, 3>> triangles;
  for (std::size_t t = 0; t < mesh.indices.size(); t += 3) {
    triangles.push_back({sorted.vertex_of[mesh.indices[t]], sorted.vertex_of[mesh.indices[t + 1]],
                         sorted.vertex_of[mesh.indices[t + 2]]});
  }
  std::stable_sort(triangles.begin(), triangles.end(),
                   [](const auto& a, const auto& b) { return *std::ranges::min_element(a) < *std::ranges::min_element(b); });
  for (const auto& t : triangles) sorted.mesh.indices.insert(sorted.mesh.indices.end(), t.begin(), t.end());
  return sorted;
}

// One an edge, those with a vertex that can move first; by their lowest vertex.
std::vector<Hinge> find_hinges(const TriangleMesh& mesh, std::span<const std::int32_t> attachment_of,
                               std::size_t& movable) {
  const MeshEdges edges = find_edges(mesh.indices, mesh.positions.size());
  std::vector<Hinge> hinges;
  for (std::size_t e = 0; e < edges.count(); ++e) {
    const std::uint32_t side = edges.sides_of(e)[0], other = edges.opposite[side];
    Hinge hinge;
    hinge.vertex = {mesh.indices[side], mesh.indices[next_side(side)], mesh.indices[next_side(next_side(side))],
                    mesh.indices[next_side(next_side(other))]};
    hinges.push_back(hinge);
  }
  const auto moves = std::stable_partition(hinges.begin(), hinges.end(), [&](const Hinge& hinge) {
    return std::ranges::any_of(hinge.vertex, [&](std::uint32_t v) { return attachment_of[v] < 0; });
  });
  movable = static_cast<std::size_t>(moves - hinges.begin());
  return hinges;
}

}  // namespace

Result<std::shared_ptr<const SurfaceAsset>> build_surface_asset(const SurfaceMuscleDescription& description,
                                                                std::uint32_t bone_count, const MuscleAsset* muscles) {
  Diagnostics found = check_surface(description, bone_count, muscles);
  if (!found.ok()) return found;

  const SortedMesh sorted = sort_by_place(description.mesh);
  const TriangleMesh& mesh = sorted.mesh;
  auto asset = std::make_shared<SurfaceAsset>();
  asset->name = description.name;
  asset->settings = description.settings;
  asset->vertex_count = static_cast<std::uint32_t>(mesh.positions.size());
  asset->triangles = mesh.indices;
  asset->file_vertex = sorted.file_vertex;
  asset->volume = mesh_volume(mesh);
  asset->size = mesh_bounds(mesh).diagonal();
  asset->frame_bone = description.frame_bone;
  asset->bones = description.bones;
  asset->bone_count = bone_count;
  asset->fibres = description.fibres;
  asset->driver = description.driver;

  std::vector<std::int32_t> attachment_of(asset->vertex_count, -1);
  for (std::size_t i = 0; i < description.attachments.size(); ++i) {
    const SurfaceAttachment& attachment = description.attachments[i];
    asset->attachments.push_back({.bone = attachment.bone, .origin = attachment.origin, .count = 0});
    for (const std::uint32_t v : attachment.vertices) {
      if (sorted.vertex_of[v] != kUnused) attachment_of[sorted.vertex_of[v]] = static_cast<std::int32_t>(i);
    }
  }
  // All vertices have one mass: with each its share of the area, small triangles' are so light that passes over the
  // constraints need much longer to agree.
  const double mass = static_cast<double>(description.settings.density) * asset->volume;
  const auto inverse = static_cast<float>(static_cast<double>(asset->vertex_count) / mass);
  for (std::uint32_t v = 0; v < asset->vertex_count; ++v) {
    const glm::vec3& p = mesh.positions[v];
    asset->rest.push_back({p.x, p.y, p.z, attachment_of[v] < 0 ? inverse : 0.0f});
    if (attachment_of[v] < 0) continue;
    asset->attached.push_back({v, static_cast<std::uint32_t>(attachment_of[v])});
    ++asset->attachments[static_cast<std::size_t>(attachment_of[v])].count;
  }
  add_padding(asset->rest);

  if (!description.driver.empty()) {
    const auto muscle = static_cast<std::uint32_t>(find_muscle(*muscles, description.driver));
    Carriage carriage = carry_by_sections(mesh.positions, *muscles, muscle);
    asset->carriers = std::move(carriage.carriers);
    asset->carry = std::move(carriage.weights);
  } else {
    Result<Carriage> carriage =
        carry_by_bones(mesh.positions, mesh.indices, attachment_of, asset->attachments, description.frame_bone);
    if (!carriage) return carriage.diagnostics();
    asset->carriers = std::move(carriage->carriers);
    asset->carry = std::move(carriage->weights);
  }

  std::size_t movable = 0;
  std::vector<Hinge> hinges = find_hinges(mesh, attachment_of, movable);
  measure_hinges(asset->rest, hinges);
  const FibreDirections directions(*asset, mesh.positions);
  double sum = 0.0;
  for (Hinge& hinge : hinges) {
    hinge.anisotropy = std::clamp(directions.across(hinge), description.settings.along_fibres, 1.0f);
    sum += static_cast<double>(hinge.length);
  }
  asset->mean_edge = static_cast<float>(sum / static_cast<double>(hinges.size()));
  PackedHinges packed = pack_hinges(std::span(hinges).first(movable), asset->vertex_count, asset->settings);
  asset->packs = std::move(packed.packs);
  asset->first_pack = std::move(packed.first_pack);
  for (const std::uint32_t i : packed.order) asset->hinges.push_back(hinges[i]);
  asset->hinges.insert(asset->hinges.end(), hinges.begin() + static_cast<std::ptrdiff_t>(movable), hinges.end());

  asset->rings = build_vertex_rings(asset->triangles, asset->vertex_count);
  AlignedVector<SurfacePoint> scratch(asset->vertex_count);
  AlignedVector<SurfacePoint> rest = asset->rest;
  asset->kernel_volume = surface_kernels(SimdLevel::kPortable)
                             .measure_volume({.triangles = asset->triangles,
                                              .vertex_count = asset->vertex_count,
                                              .points = rest,
                                              .gradient = scratch,
                                              .rings = &asset->rings});

  asset->tree = std::make_shared<const SurfaceTree>(build_surface_tree(*asset));

  return std::shared_ptr<const SurfaceAsset>(std::move(asset));
}

}  // namespace fascicle::muscle
