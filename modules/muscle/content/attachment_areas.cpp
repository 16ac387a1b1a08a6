#include "modules/muscle/content/attachment_areas.hpp"

#include <functional>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "engine/animation/skeleton.hpp"
#include "engine/geometry/closest_point.hpp"

namespace fascicle::muscle {
namespace {

std::vector<std::uint32_t> triangles_where(const TriangleMesh& mesh,
                                           const std::function<bool(const glm::vec3&)>& inside) {
  std::vector<char> marked(mesh.positions.size());
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) marked[i] = inside(mesh.positions[i]);
  std::vector<std::uint32_t> triangles;
  for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
    if (marked[mesh.indices[i]] && marked[mesh.indices[i + 1]] && marked[mesh.indices[i + 2]]) {
      triangles.push_back(static_cast<std::uint32_t>(i / 3));
    }
  }
  return triangles;
}

std::vector<std::uint32_t> find_area(const AreaEntry& area, const AttachmentDescription& attachment,
                                     const TriangleMesh& mesh, const CharacterAsset& asset, Diagnostics& diagnostics) {
  std::vector<std::uint32_t> triangles;
  if (area.of_bone) {
    const std::int32_t bone = area.bone.given() ? asset.skeleton->find(area.bone.text) : attachment.bone;
    const ClosestPoints surface(bone_mesh_at_rest(asset, bone));
    if (surface.empty()) {
      area.node.warning(diagnostics,
                        fmt::format("the bone '{}' has no mesh to measure the area's distance from",
                                    asset.skeleton->names[static_cast<std::size_t>(bone)]),
                        "give it one in \"bone_meshes\", or the area a \"radius_mm\"; no area is used");
      return triangles;
    }
    triangles = triangles_where(mesh, [&](const glm::vec3& p) { return surface.at(p).distance <= area.within; });
  } else {
    const glm::mat4& rest = asset.skeleton->rest_world[static_cast<std::size_t>(attachment.bone)];
    const glm::vec3 centre(rest * glm::vec4(attachment.position, 1.0f));
    triangles = triangles_where(mesh, [&](const glm::vec3& p) { return glm::distance(p, centre) <= area.within; });
  }
  if (triangles.empty()) {
    area.node.warning(diagnostics, fmt::format("no triangle of the mesh lies in the area ({:.4g} mm)", 1000 * area.within),
                      "give a larger distance, or leave the area out; none is used");
  }
  return triangles;
}

}  // namespace

TriangleMesh bone_mesh_at_rest(const CharacterAsset& asset, std::int32_t bone) {
  TriangleMesh joined;
  for (const BoneMesh& part : asset.bone_meshes) {
    if (part.bone != bone) continue;
    const glm::mat4 to_rest = asset.skeleton->rest_world[static_cast<std::size_t>(bone)] * part.transform;
    const auto first = static_cast<std::uint32_t>(joined.positions.size());
    for (const glm::vec3& position : part.mesh->positions) {
      joined.positions.push_back(glm::vec3(to_rest * glm::vec4(position, 1.0f)));
    }
    for (const std::uint32_t index : part.mesh->indices) joined.indices.push_back(first + index);
  }
  return joined;
}

std::array<std::vector<std::uint32_t>, 2> find_attachment_areas(const ResolvedMuscle& muscle, const TriangleMesh& mesh,
                                                                const CharacterAsset& asset,
                                                                Diagnostics& diagnostics) {
  std::array<std::vector<std::uint32_t>, 2> areas;
  const auto& attachments = muscle.description.attachments;
  for (std::size_t end = 0; end < 2; ++end) {
    const AreaEntry& area = muscle.areas[end];
    if (!area.given()) continue;
    areas[end] = find_area(area, end == 0 ? attachments.front() : attachments.back(), mesh, asset, diagnostics);
  }
  return areas;
}

}  // namespace fascicle::muscle
