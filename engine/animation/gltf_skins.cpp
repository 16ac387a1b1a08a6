#include "engine/animation/gltf_skins.hpp"

namespace fascicle {

std::shared_ptr<const SkinAsset> make_skin_asset(const GltfFile& file, const GltfMesh& mesh) {
  auto asset = std::make_shared<SkinAsset>();
  asset->name = mesh.name;
  asset->positions = mesh.geometry.positions;
  asset->normals = mesh.geometry.normals;
  asset->indices = mesh.geometry.indices;
  asset->base_colour = mesh.base_colour;
  if (mesh.skin >= 0) {
    const GltfSkin& skin = file.skins[static_cast<std::size_t>(mesh.skin)];
    asset->joint_bones = skin.bones;
    asset->inverse_binds = skin.inverse_binds;
    asset->joints = mesh.joints;
    asset->weights = mesh.weights;
  } else {
    asset->joint_bones = {mesh.bone};
    asset->inverse_binds = {glm::mat4(1.0f)};
    asset->joints.assign(asset->size(), glm::u16vec4(0));
    asset->weights.assign(asset->size(), glm::vec4(1.0f, 0.0f, 0.0f, 0.0f));
  }
  return asset;
}

}  // namespace fascicle
