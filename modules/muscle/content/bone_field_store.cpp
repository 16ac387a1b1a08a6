#include "modules/muscle/content/bone_field_store.hpp"

#include <memory>
#include <utility>
#include <vector>

#include <glm/vec4.hpp>

#include "engine/animation/skeleton.hpp"
#include "engine/content/triangle_mesh.hpp"
#include "modules/muscle/asset/bone_fields/bone_grid.hpp"

namespace fascicle::muscle {

namespace {

TriangleMesh in_bone_frame(const BoneMesh& part) {
  TriangleMesh mesh;
  mesh.indices = part.mesh->indices;
  mesh.positions.reserve(part.mesh->positions.size());
  for (const glm::vec3& position : part.mesh->positions) {
    mesh.positions.push_back(glm::vec3(part.transform * glm::vec4(position, 1.0f)));
  }
  return mesh;
}

}  // namespace

void load_bone_fields(const std::filesystem::path& character_file, CharacterAsset& asset, Diagnostics& diagnostics) {
  const std::size_t bones = asset.skeleton->names.size();
  asset.bone_fields.assign(bones, nullptr);
  std::vector<std::vector<TriangleMesh>> meshes(bones);
  for (const BoneMesh& part : asset.bone_meshes) {
    meshes[static_cast<std::size_t>(part.bone)].push_back(in_bone_frame(part));
  }
  for (std::size_t bone = 0; bone < bones; ++bone) {
    if (meshes[bone].empty()) continue;
    const BoneGridSettings settings{.voxel = asset.collision.settings.bone_voxel};
    auto field = build_bone_field(meshes[bone], asset.skeleton->names[bone], settings);
    if (field) {
      asset.bone_fields[bone] = *field;
      continue;
    }
    Diagnostic warning = field.diagnostics().errors.front();
    warning.path = "bone " + asset.skeleton->names[bone];
    warning.file = character_file.string();
    diagnostics.warnings.push_back(std::move(warning));
  }
}

}  // namespace fascicle::muscle
