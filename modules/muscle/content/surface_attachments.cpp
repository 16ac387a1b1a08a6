#include "modules/muscle/content/surface_attachments.hpp"

#include <algorithm>
#include <limits>
#include <map>
#include <tuple>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "engine/animation/skeleton.hpp"
#include "engine/geometry/closest_point.hpp"
#include "engine/geometry/mesh_measures.hpp"
#include "modules/muscle/content/attachment_areas.hpp"

namespace fascicle::muscle {

namespace {

using Choice = SurfaceAttachmentEntry::Choice;
using Vertices = std::vector<std::uint32_t>;

// Those whose `distance` is no more than the entry's; an error that tells the nearest where there are none.
template <class Distance>
Vertices take_near(const SurfaceAttachmentEntry& entry, std::span<const glm::vec3> positions, const std::string& what,
                   Distance distance, Diagnostics& diagnostics) {
  Vertices vertices;
  double least = std::numeric_limits<double>::infinity();
  for (std::uint32_t v = 0; v < positions.size(); ++v) {
    const double d = distance(positions[v]);
    least = std::min(least, d);
    if (d <= static_cast<double>(entry.distance)) vertices.push_back(v);
  }
  if (vertices.empty()) {
    entry.node.error(diagnostics,
                     fmt::format("no vertex of the muscle lies within {:.4g} mm of {}, the nearest is {:.4g} mm away",
                                 1000.0 * static_cast<double>(entry.distance), what, 1000.0 * least),
                     "give a larger distance, or look whether mesh and bone stand where they should (unit, place)");
  }
  return vertices;
}

Vertices take_beyond(const SurfaceAttachmentEntry& entry, const SurfaceMesh& mesh, Diagnostics& diagnostics) {
  const std::vector<glm::vec3>& positions = entry.plane_in_rest_space ? mesh.rest.positions : mesh.in_file;
  Vertices vertices;
  double highest = -std::numeric_limits<double>::infinity();
  for (std::uint32_t v = 0; v < positions.size(); ++v) {
    const double height = glm::dot(entry.normal, glm::dvec3(positions[v]));
    highest = std::max(highest, height);
    if (height > entry.offset) vertices.push_back(v);
  }
  if (vertices.empty()) {
    entry.node.error(diagnostics,
                     fmt::format("no vertex of the muscle lies beyond the plane at {:.6g}, the furthest is at {:.6g}",
                                 entry.offset, highest),
                     entry.plane_in_rest_space
                         ? "\"at\" is in metres along the normal, in the character's rest space"
                         : "\"at\" is in the mesh file's own coordinates and unit, along the normal");
  }
  return vertices;
}

// Numbers of the file as numbers of the mended mesh. Mending keeps a vertex' place; one that was welded has another at
// its own.
Vertices take_listed(const SurfaceAttachmentEntry& entry, const SurfaceMesh& mesh, Diagnostics& diagnostics) {
  const std::vector<glm::vec3>& in_file = mesh.source->positions;
  using Place = std::tuple<float, float, float>;
  const auto place = [](const glm::vec3& p) { return Place{p.x, p.y, p.z}; };
  std::map<Place, std::uint32_t> known;
  for (std::uint32_t v = 0; v < mesh.in_file.size(); ++v) known.emplace(place(mesh.in_file[v]), v);
  const double reach = 2e-6 * static_cast<double>(mesh_bounds(*mesh.source).diagonal());
  const auto find_near = [&](const glm::vec3& p) -> std::int64_t {
    for (std::uint32_t v = 0; v < mesh.in_file.size(); ++v) {
      if (glm::distance(glm::dvec3(mesh.in_file[v]), glm::dvec3(p)) <= reach) return v;
    }
    return -1;
  };
  Vertices vertices;
  for (const std::uint32_t number : entry.vertices) {
    if (number >= in_file.size()) {
      entry.node.error(diagnostics, fmt::format("vertex {}, but the mesh has {} vertices", number, in_file.size()),
                       "count them from 0, in the file's order");
      return {};
    }
    const auto found = known.find(place(in_file[number]));
    const std::int64_t vertex = found != known.end() ? std::int64_t{found->second} : find_near(in_file[number]);
    if (vertex < 0) {
      entry.node.error(diagnostics, fmt::format("vertex {} belongs to no triangle of the muscle", number),
                       "leave it out; does it belong to another piece of the mesh?");
      return {};
    }
    vertices.push_back(static_cast<std::uint32_t>(vertex));
  }
  std::ranges::sort(vertices);
  vertices.erase(std::ranges::unique(vertices).begin(), vertices.end());
  return vertices;
}

}  // namespace

Vertices choose_attached_vertices(const SurfaceAttachmentEntry& entry, const SurfaceMesh& mesh,
                                  const CharacterAsset& asset, std::int32_t bone, bool in_rest_space,
                                  Diagnostics& diagnostics) {
  const std::string& name = asset.skeleton->names[static_cast<std::size_t>(bone)];
  const std::vector<glm::vec3>& positions = mesh.rest.positions;
  switch (entry.choice) {
    case Choice::kNone: return {};
    case Choice::kWithin: {
      const ClosestPoints surface(bone_mesh_at_rest(asset, bone));
      if (surface.empty()) {
        entry.node.error(diagnostics, fmt::format("the bone '{}' has no mesh to measure the distance from", name),
                         "give it one in \"bone_meshes\", or choose with \"near\", \"beyond\" or \"vertices\"");
        return {};
      }
      const auto distance = [&](const glm::vec3& p) { return static_cast<double>(surface.at(p).distance); };
      return take_near(entry, positions, fmt::format("'{}'", name), distance, diagnostics);
    }
    case Choice::kNear: {
      const glm::mat4& rest = asset.skeleton->rest_world[static_cast<std::size_t>(bone)];
      const glm::vec3 centre = in_rest_space ? entry.point : glm::vec3(rest * glm::vec4(entry.point, 1.0f));
      const auto distance = [&](const glm::vec3& p) { return glm::distance(glm::dvec3(p), glm::dvec3(centre)); };
      return take_near(entry, positions, "the point", distance, diagnostics);
    }
    case Choice::kBeyond: return take_beyond(entry, mesh, diagnostics);
    case Choice::kVertices: return take_listed(entry, mesh, diagnostics);
  }
  return {};
}

}  // namespace fascicle::muscle
