// Resource: how the muscle systems work. Nothing in here changes results.
#pragma once

#include <cstddef>

#include "engine/math/simd_level.hpp"

namespace fascicle::muscle {

struct MuscleSettings {
  SimdLevel simd = detect_simd();
  // Size of all musculatures' surfaces together (bytes) from which on they are stored past the caches: beyond what a
  // last-level cache holds, that saves reading every line before it is overwritten.
  std::size_t stream_bytes = std::size_t{24} << 20;
};

}  // namespace fascicle::muscle
