// State: where the action lines' points a_k are (1.1). On a musculature's entity.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <glm/vec3.hpp>

#include "engine/math/aligned_vector.hpp"

namespace fascicle::muscle {

struct MuscleAsset;

struct ActionLines {
  AlignedVector<float> x, y, z;  // m, world; by slot (MuscleAsset::slot)
  // Muscles that keep their last finite line because a bone of theirs is missing or not finite.
  std::vector<std::uint8_t> held;        // by muscle: 1
  AlignedVector<std::int32_t> held_lanes;  // by lane: -1
  bool any_held = false;
  std::uint64_t held_steps = 0;  // muscle steps held since the spawn
};

// The place of a section's centre a_k (m).
glm::vec3 line_point(const MuscleAsset& asset, const ActionLines& lines, std::uint32_t muscle, std::uint32_t section);

std::size_t heap_bytes(const ActionLines& lines);

}  // namespace fascicle::muscle
