#include "modules/muscle/content/surface_clearance.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "engine/animation/skeleton.hpp"
#include "engine/geometry/clean_mesh.hpp"
#include "engine/geometry/mesh_measures.hpp"
#include "engine/geometry/winding_number.hpp"
#include "modules/muscle/asset/surface/check_surface.hpp"
#include "modules/muscle/content/attachment_areas.hpp"

namespace fascicle::muscle {

namespace {

std::vector<glm::vec3> movable(const SurfaceMuscleDescription& muscle) {
  std::vector<std::uint8_t> attached(muscle.mesh.positions.size(), 0);
  for (const SurfaceAttachment& attachment : muscle.attachments) {
    for (const std::uint32_t v : attachment.vertices) attached[v] = 1;
  }
  std::vector<glm::vec3> points;
  for (std::size_t v = 0; v < attached.size(); ++v) {
    if (attached[v] == 0) points.push_back(muscle.mesh.positions[v]);
  }
  return points;
}

bool holds(const Bounds& box, const glm::vec3& p) {
  return p.x >= box.lower.x && p.y >= box.lower.y && p.z >= box.lower.z &&  //
         p.x <= box.upper.x && p.y <= box.upper.y && p.z <= box.upper.z;
}

bool holds_all(const TriangleMesh& bone, std::span<const glm::vec3> points) {
  if (bone.indices.empty() || points.empty()) return false;
  const Bounds box = mesh_bounds(bone);
  if (!std::ranges::all_of(points, [&](const glm::vec3& p) { return holds(box, p); })) return false;
  const WindingField winding(clean_mesh(bone).mesh);  // bones may come inside out
  return std::ranges::all_of(points, [&](const glm::vec3& p) { return winding.inside(p); });
}

}  // namespace

void check_swallowed(const SurfaceMuscleDescription& muscle, const CharacterAsset& asset, Diagnostics& diagnostics) {
  if (!muscle.settings.collide_with_bones) return;
  const std::vector<glm::vec3> points = movable(muscle);
  for (const std::int32_t bone : muscle.bones) {
    if (!holds_all(bone_mesh_at_rest(asset, bone), points)) continue;
    diagnostics.errors.push_back(fault_of(
        muscle, "mesh",
        fmt::format("the bone '{}' swallows it: at rest all {} vertices that are free to move are inside",
                    asset.skeleton->names[static_cast<std::size_t>(bone)], points.size()),
        "correct the unit or the place of one of the two meshes, or leave the bone out of \"bones\""));
    return;
  }
}

}  // namespace fascicle::muscle
