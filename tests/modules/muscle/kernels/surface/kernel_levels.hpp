// The surface muscles' kernels of every instruction set that this processor has, and what tests ask of points.
#pragma once

#include <cstring>
#include <vector>

#include <glm/vec3.hpp>

#include "engine/math/simd_level.hpp"
#include "modules/muscle/kernels/surface/surface_kernels.hpp"

namespace fascicle::muscle::test {

inline std::vector<SimdLevel> levels() {
  std::vector<SimdLevel> result;
  for (const SimdLevel level : {SimdLevel::kPortable, SimdLevel::kAvx2, SimdLevel::kAvx512}) {
    if (level <= detect_simd()) result.push_back(level);
  }
  return result;
}

inline glm::dvec3 place(const SurfacePoint& p) { return {p.x, p.y, p.z}; }

template <class Vector>
bool same_bits(const Vector& a, const Vector& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(a[0])) == 0;
}

}  // namespace fascicle::muscle::test
