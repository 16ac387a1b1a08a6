#include "modules/muscle/kernels/hull/line_place.hpp"

#include <cstddef>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace fascicle::muscle {

glm::vec3 place_along(std::span<const glm::vec3> line, float along) {
  if (line.empty()) return glm::vec3(0.0f);
  float left = 0.0f;
  for (std::size_t i = 0; i + 1 < line.size(); ++i) left += glm::distance(line[i], line[i + 1]);
  if (!(left > 0.0f)) return line.front();
  left *= glm::clamp(along, 0.0f, 1.0f);
  for (std::size_t i = 0; i + 1 < line.size(); ++i) {
    const float length = glm::distance(line[i], line[i + 1]);
    if (left <= length && length > 0.0f) return glm::mix(line[i], line[i + 1], left / length);
    left -= length;
  }
  return line.back();
}

}  // namespace fascicle::muscle
