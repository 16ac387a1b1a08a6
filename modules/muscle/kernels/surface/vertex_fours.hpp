// Points as records of four floats, four vertices side by side, the last ones perhaps fewer.
// For the kernels' source files only (see engine/math/wide_float.hpp).
#pragma once

#include <cstddef>

#include "engine/math/wide_float.hpp"

namespace fascicle::muscle::FASCICLE_ISA {

using namespace fascicle::FASCICLE_ISA;

inline constexpr int kMassLanes[16] = {0, 0, 0, -1, 0, 0, 0, -1, 0, 0, 0, -1, 0, 0, 0, -1};

// Records that arrays of `vertex_count` do not have are zero.
FASCICLE_INLINE WideFloat<16> load_vertices(const float* records, std::size_t four, std::size_t vertex_count) {
  if (4 * four + 4 <= vertex_count) return load<16>(records + 16 * four);
  float last[16] = {};
  for (std::size_t i = 0; i < 4 * (vertex_count - 4 * four); ++i) last[i] = records[16 * four + i];
  return load<16>(last);
}

FASCICLE_INLINE void store_vertices(WideFloat<16> a, float* records, std::size_t four, std::size_t vertex_count) {
  if (4 * four + 4 <= vertex_count) return store(a, records + 16 * four);
  float last[16];
  store(a, last);
  for (std::size_t i = 0; i < 4 * (vertex_count - 4 * four); ++i) records[16 * four + i] = last[i];
}

}  // namespace fascicle::muscle::FASCICLE_ISA
