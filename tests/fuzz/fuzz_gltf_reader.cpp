// Any bytes as .gltf or .glb. Whatever is accepted must hold together: indices in range, numbers finite.
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <vector>

#include "engine/animation/clip.hpp"
#include "engine/content/gltf_reader.hpp"
#include "engine/content/mesh_reader.hpp"

namespace {

void require(bool condition) {
  if (!condition) std::abort();
}

void check(const fascicle::GltfFile& file) {
  const std::size_t bones = file.skeleton.size();
  require(file.skeleton.parents.size() == bones && file.skeleton.rest_world.size() == bones);
  for (std::size_t i = 0; i < bones; ++i) require(file.skeleton.parents[i] < static_cast<std::int32_t>(i));
  for (const fascicle::GltfSkin& skin : file.skins) {
    for (const std::int32_t bone : skin.bones) require(bone >= 0 && static_cast<std::size_t>(bone) < bones);
  }
  for (const fascicle::GltfMesh& mesh : file.meshes) {
    const std::size_t count = mesh.geometry.positions.size();
    require(mesh.geometry.normals.size() == count);
    for (const std::uint32_t index : mesh.geometry.indices) require(index < count);
    for (const glm::vec3& n : mesh.geometry.normals)
      require(std::abs(n.x * n.x + n.y * n.y + n.z * n.z - 1.0f) < 1e-3f);
    if (mesh.skin < 0) continue;
    require(mesh.joints.size() == count && mesh.weights.size() == count);
    const std::size_t joints = file.skins[static_cast<std::size_t>(mesh.skin)].bones.size();
    for (std::size_t i = 0; i < count; ++i) {
      for (int k = 0; k < 4; ++k) require(mesh.joints[i][k] < joints && mesh.weights[i][k] >= 0.0f);
    }
  }
  for (const fascicle::Clip& clip : file.clips) {
    std::vector<fascicle::Trs> pose = file.skeleton.rest_local;
    for (const float fraction : {0.0f, 0.3f, 1.0f})
      fascicle::sample_clip(clip, clip.start + fraction * clip.duration(), pose);
    for (const fascicle::Trs& trs : pose) {
      require(std::isfinite(trs.translation.x) && std::isfinite(trs.rotation.w) && std::isfinite(trs.scale.z));
    }
  }
  (void)fascicle::extract_mesh(file, "");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto result = fascicle::parse_gltf({data, size}, {}, "fuzz");
  if (result) check(*result);
  require(result.ok() || !result.diagnostics().errors.empty());
  return 0;
}
