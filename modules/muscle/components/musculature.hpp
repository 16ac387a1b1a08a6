// The entities of muscles: a musculature is all muscles of one asset on one character, and carries the flat state
// components; each muscle also has a small entity of its own, for gameplay to hang components on.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "engine/ecs/entity.hpp"

namespace fascicle::muscle {

struct MuscleAsset;

// On a musculature's entity.
struct Musculature {
  std::shared_ptr<const MuscleAsset> asset;
  ecs::Entity character;                 // has BoneMatrices
  std::vector<ecs::Entity> muscles;      // by index in the asset; kNoEntity once detached
  std::vector<std::uint8_t> attached;    // 0: detached; its surface is collapsed to a point and draws nothing
};

// On a muscle's entity.
struct Muscle {
  ecs::Entity musculature;
  std::uint32_t index = 0;  // in the musculature's asset
};

std::size_t heap_bytes(const Musculature& musculature);

}  // namespace fascicle::muscle
