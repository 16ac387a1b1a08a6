// Component and system that put skins on characters.
#pragma once

#include <memory>

#include "engine/animation/skinning.hpp"
#include "engine/ecs/entity.hpp"
#include "engine/ecs/view.hpp"

namespace fascicle {

// Component: the entity wears `asset` on the bones of `character`, which may be the entity itself.
struct SkinInstance {
  std::shared_ptr<const SkinAsset> asset;
  ecs::Entity character;
};

// An instance whose character is gone, or has fewer bones than the asset asks for, keeps its last surface.
void skin_meshes(ecs::View<const SkinInstance, SkinnedSurface> skins, ecs::View<const BoneMatrices> characters);

}  // namespace fascicle
