// Which samples are in a bone, or about to be.
#pragma once

#include <span>

#include <glm/mat4x4.hpp>

#include "modules/muscle/asset/collision/collision_asset.hpp"
#include "modules/muscle/kernels/collision/collision_work.hpp"

namespace fascicle::muscle {

// Appends contacts for samples less than `reach` (m) away from being as deep as they are at rest, less `margin` (m).
// `bones`: the character's matrices, bone to world, rigid.
void find_bone_contacts(const CollisionAsset& asset, std::span<const glm::mat4> bones, float margin, float reach,
                        CollisionWork& work);

// Asks the fields again for the bone contacts that there are, at their samples' present places.
void refresh_bone_contacts(const CollisionAsset& asset, std::span<const glm::mat4> bones, float margin,
                           CollisionWork& work);

}  // namespace fascicle::muscle
