#include "engine/animation/skinning_systems.hpp"

#include <algorithm>

#include "engine/parallel/for_range.hpp"

namespace fascicle {
namespace {

constexpr std::size_t kVerticesPerTask = 2048;  // some ten microseconds

bool fits(const SkinAsset& asset, const BoneMatrices& bones, const SkinnedSurface& surface) {
  const auto last = std::ranges::max_element(asset.joint_bones);
  return last != asset.joint_bones.end() && static_cast<std::size_t>(*last) < bones.world.size() &&
         surface.positions.size() == asset.size() && surface.normals.size() == asset.size() &&
         surface.joint_matrices.size() == asset.joint_bones.size();
}

void skin_one(const SkinAsset& asset, const BoneMatrices& bones, SkinnedSurface& surface) {
  compute_joint_matrices(asset, bones.world, surface.joint_matrices);
  parallel::for_range(asset.size(), kVerticesPerTask, [&](std::size_t begin, std::size_t end) {
    skin_vertices(asset, surface.joint_matrices, begin, end, surface.positions, surface.normals);
  });
}

}  // namespace

void skin_meshes(ecs::View<const SkinInstance, SkinnedSurface> skins, ecs::View<const BoneMatrices> characters) {
  parallel::for_range(skins.candidates(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      skins.visit(i, [&](const SkinInstance& instance, SkinnedSurface& surface) {
        const BoneMatrices* bones = characters.try_get<const BoneMatrices>(instance.character);
        if (instance.asset == nullptr || bones == nullptr || !fits(*instance.asset, *bones, surface)) return;
        if (!are_usable(bones->world)) return;  // a host's own animation may have failed
        skin_one(*instance.asset, *bones, surface);
      });
    }
  });
}

}  // namespace fascicle
