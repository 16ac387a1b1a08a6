// What contacts cannot see, because they only know the nearest way out: a section that is on the wrong side.
#pragma once

#include <span>

#include <glm/mat4x4.hpp>

#include "modules/muscle/asset/collision/collision_asset.hpp"
#include "modules/muscle/kernels/collision/collision_work.hpp"

namespace fascicle::muscle {

// Transversal constraints (3.1): where a tag lies deeper in its partner than the section's radius, the sections have
// swapped sides or one is half swallowed, and their centres go back by that depth, of both or of the one that yields.
void hold_transversals(const CollisionAsset& asset, std::span<const glm::mat4> bones, CollisionWork& work);

// The depth of one, beyond the one at rest; 0 where its tags do not face each other.
float transversal_depth(const CollisionAsset& asset, const Transversal& transversal, std::span<const glm::mat4> bones,
                        const CollisionWork& work);

// Sections whose way from where their bones carry them to where they are leads through a bone go back to where they
// are carried. Untagged muscles need it after a jump.
void recall_strayed(const CollisionAsset& asset, std::span<const glm::mat4> bones, CollisionWork& work);

}  // namespace fascicle::muscle
