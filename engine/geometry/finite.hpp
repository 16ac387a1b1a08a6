// Whether a point is a place at all.
#pragma once

#include <cmath>

#include <glm/vec3.hpp>

namespace fascicle {

template <class T>
bool is_finite(const glm::vec<3, T>& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

}  // namespace fascicle
