#include "modules/muscle/kernels/hull/line_place.hpp"

#include <algorithm>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace fascicle::muscle {
namespace {

struct Segment {
  std::size_t first = 0;
  float part = 0.0f;  // 0..1 of it
};

Segment find_segment(std::span<const HullLinePoint> rest, float along) {
  float left = 0.0f;
  for (std::size_t i = 0; i + 1 < rest.size(); ++i) left += glm::distance(rest[i].rest, rest[i + 1].rest);
  left *= glm::clamp(along, 0.0f, 1.0f);
  Segment last;
  for (std::size_t i = 0; i + 1 < rest.size(); ++i) {
    const float length = glm::distance(rest[i].rest, rest[i + 1].rest);
    if (left <= length && length > 0.0f) return {i, left / length};
    left -= length;
    last = {i, 1.0f};
  }
  return last;
}

}  // namespace

glm::vec3 rest_place_along(std::span<const HullLinePoint> rest, float along) {
  if (rest.size() < 2) return rest.empty() ? glm::vec3(0.0f) : rest[0].rest;
  const Segment segment = find_segment(rest, along);
  return glm::mix(rest[segment.first].rest, rest[segment.first + 1].rest, segment.part);
}

glm::vec3 place_along(std::span<const HullLinePoint> rest, std::span<const glm::vec3> line, float along) {
  const std::size_t count = std::min(rest.size(), line.size());
  if (count < 2) return count == 0 ? glm::vec3(0.0f) : line[0];
  const Segment segment = find_segment(rest.first(count), along);
  return glm::mix(line[segment.first], line[segment.first + 1], segment.part);
}

}  // namespace fascicle::muscle
