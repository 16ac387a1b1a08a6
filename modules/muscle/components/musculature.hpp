// The entities of muscles: a musculature is all muscles of one asset on one character, and carries the flat state
// components; each muscle also has a small entity of its own, for gameplay to hang components on.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "engine/ecs/entity.hpp"

namespace fascicle::muscle {

struct LevelMorph;
struct MuscleAsset;

// On a musculature's entity.
struct Musculature {
  std::shared_ptr<const MuscleAsset> asset;
  ecs::Entity character;                 // has BoneMatrices
  std::vector<ecs::Entity> muscles;      // by index in the asset; kNoEntity once detached
  std::vector<std::uint8_t> attached;    // 0: detached; its surface is collapsed to a point and draws nothing
  // Where `asset` is one of several levels of detail (MuscleDetail): what it becomes, and how far it has, 0..1.
  const LevelMorph* coarser = nullptr;   // not null where morph > 0
  float morph = 0.0f;
};

// On a muscle's entity.
struct Muscle {
  ecs::Entity musculature;
  std::uint32_t index = 0;  // in the musculature's asset
};

std::size_t heap_bytes(const Musculature& musculature);

}  // namespace fascicle::muscle
