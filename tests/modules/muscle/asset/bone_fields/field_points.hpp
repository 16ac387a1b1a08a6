// Points to ask fields at, always the same ones.
#pragma once

#include <cstddef>
#include <random>
#include <vector>

#include <glm/vec3.hpp>

namespace fascicle::test {

inline std::vector<glm::vec3> points_in_box(const glm::vec3& lower, const glm::vec3& upper, std::size_t count) {
  std::mt19937 generator(7);
  const auto fraction = [&] { return static_cast<float>(generator() >> 8) / 16777216.0f; };
  std::vector<glm::vec3> points(count);
  for (glm::vec3& point : points) {
    for (int axis = 0; axis < 3; ++axis) point[axis] = lower[axis] + fraction() * (upper[axis] - lower[axis]);
  }
  return points;
}

}  // namespace fascicle::test
