// Where a place that is deep inside of a bone came in: for both solvers' contacts.
#pragma once

#include <glm/common.hpp>
#include <glm/vec3.hpp>

#include "modules/muscle/asset/collision/bone_field.hpp"

namespace fascicle::muscle {

// m inside, in voxels: deeper than this the nearest surface need not be the one that it came through.
inline constexpr float kShallow = 2.0f;

// Where the way from `outside` to `inside` comes as near as `distance` (m); all in the bone's frame.
inline glm::vec3 way_in(const BoneField& field, const glm::vec3& outside, const glm::vec3& inside, float distance) {
  constexpr int kBisections = 12;
  float out = 0.0f, in = 1.0f;
  for (int i = 0; i < kBisections; ++i) {
    const float middle = 0.5f * (out + in);
    (field.distance(glm::mix(outside, inside, middle)) < distance ? in : out) = middle;
  }
  return glm::mix(outside, inside, out);
}

}  // namespace fascicle::muscle
