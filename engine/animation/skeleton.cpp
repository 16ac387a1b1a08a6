#include "engine/animation/skeleton.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace fascicle {

std::int32_t Skeleton::find(std::string_view name) const {
  const auto found = std::ranges::find(names, name);
  return found == names.end() ? -1 : static_cast<std::int32_t>(found - names.begin());
}

void compose(const Skeleton& skeleton, std::span<const Trs> local, const glm::mat4& root, std::span<glm::mat4> world) {
  assert(local.size() == skeleton.size() && world.size() == skeleton.size());
  for (std::size_t i = 0; i < local.size(); ++i) {
    const std::int32_t parent = skeleton.parents[i];
    assert(parent < static_cast<std::int32_t>(i));
    world[i] = (parent < 0 ? root : world[static_cast<std::size_t>(parent)]) * to_matrix(local[i]);
  }
}

bool are_usable(std::span<const glm::mat4> matrices) {
  bool usable = true;  // one flag and no early exit, so that the loop runs in SIMD
  for (const glm::mat4& matrix : matrices) {
    const float* entries = &matrix[0][0];
    for (int i = 0; i < 16; ++i) usable &= std::abs(entries[i]) <= kLargestMatrixEntry;  // false for NaN
  }
  return usable;
}

glm::mat4 to_matrix(const Placement& placement) {
  return to_matrix(Trs{placement.position, placement.rotation, glm::vec3(1.0f)});
}

LocalPose make_rest_pose(std::shared_ptr<const Skeleton> skeleton) {
  LocalPose pose;
  pose.bones = skeleton->rest_local;
  pose.skeleton = std::move(skeleton);
  return pose;
}

}  // namespace fascicle
