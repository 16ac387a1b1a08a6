// Fields of bones whose distances are formulas, sampled directly: no mesh, no level set library.
#pragma once

#include <algorithm>
#include <memory>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include "modules/muscle/asset/collision/bone_field.hpp"

namespace fascicle::test {

// The surface lies between `lower` and `upper`; `distance` (m, negative inside) of a point in the bone's frame.
template <class Distance>
std::shared_ptr<const muscle::BoneField> analytic_bone(const glm::vec3& lower, const glm::vec3& upper, float voxel,
                                                       Distance&& distance) {
  muscle::BoneSamples field;
  field.voxel = voxel;
  field.band = 4.0f * voxel;
  field.lower = lower;
  field.upper = upper;
  field.origin = lower - field.band - voxel;
  const float brick = voxel * static_cast<float>(muscle::kBrickCells);
  field.count = glm::ivec3(glm::ceil((upper + field.band + voxel - field.origin) / brick));
  std::uint32_t number = 0;
  for (int i = 0; i < field.count.x; ++i) {
    for (int j = 0; j < field.count.y; ++j) {
      for (int k = 0; k < field.count.z; ++k) {
        field.bricks.push_back(number++);
        const glm::vec3 corner = field.origin + brick * glm::vec3(i, j, k);
        for (int x = 0; x < muscle::kBrickSamples; ++x) {
          for (int y = 0; y < muscle::kBrickSamples; ++y) {
            for (int z = 0; z < muscle::kBrickSamples; ++z) {
              field.samples.push_back(distance(corner + voxel * glm::vec3(x, y, z)));
            }
          }
        }
      }
    }
  }
  return std::make_shared<const muscle::BoneField>(std::move(field));
}

inline float box_distance(const glm::vec3& point, const glm::vec3& lower, const glm::vec3& upper) {
  const glm::vec3 q = glm::abs(point - 0.5f * (lower + upper)) - 0.5f * (upper - lower);
  return glm::length(glm::max(q, glm::vec3(0.0f))) + std::min(std::max({q.x, q.y, q.z}), 0.0f);
}

inline std::shared_ptr<const muscle::BoneField> box_bone(const glm::vec3& lower, const glm::vec3& upper,
                                                         float voxel = 0.004f) {
  return analytic_bone(lower, upper, voxel, [&](const glm::vec3& p) { return box_distance(p, lower, upper); });
}

inline std::shared_ptr<const muscle::BoneField> sphere_bone(float radius, float voxel = 0.002f) {
  return analytic_bone(glm::vec3(-radius), glm::vec3(radius), voxel,
                       [&](const glm::vec3& p) { return glm::length(p) - radius; });
}

}  // namespace fascicle::test
