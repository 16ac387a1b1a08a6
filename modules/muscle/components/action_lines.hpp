// State: where the action lines' points a_k are (1.1). On a musculature's entity.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "engine/math/aligned_vector.hpp"

namespace fascicle::muscle {

struct ActionLines {
  AlignedVector<float> x, y, z;  // m, world; by slot (MuscleAsset::slot)
  // By muscle: 1 where one of its bones was not finite, so that it keeps the last finite line.
  std::vector<std::uint8_t> held;
  std::uint64_t held_steps = 0;  // muscle steps held since the spawn
};

std::size_t heap_bytes(const ActionLines& lines);

}  // namespace fascicle::muscle
