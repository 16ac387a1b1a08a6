#include "engine/animation/clip_travel.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

namespace fascicle {
namespace {

constexpr float kLeastDeterminant = 1e-12f;  // below this the frame above the root is flat

// The value at a key, between the tangents where there are any.
glm::vec3 key_value(const Clip& clip, const ClipChannel& channel, std::uint32_t key) {
  const std::uint32_t at = channel.interpolation == ClipInterpolation::kCubicSpline ? 3 * key + 1 : key;
  return glm::vec3(clip.values[channel.first_value + at]);
}

bool moves(const Clip& clip, const ClipChannel& channel) {
  const glm::vec3 first = key_value(clip, channel, 0);
  for (std::uint32_t key = 1; key < channel.key_count; ++key) {
    if (key_value(clip, channel, key) != first) return true;
  }
  return false;
}

// How many bones stand above it.
int depth_of(const Skeleton& skeleton, std::int32_t bone) {
  int depth = 0;
  while ((bone = skeleton.parents[static_cast<std::size_t>(bone)]) >= 0) ++depth;
  return depth;
}

// Directions of the bone's parent to the character's space.
glm::mat3 frame_above(const Skeleton& skeleton, std::int32_t bone, std::span<const Trs> pose) {
  glm::mat3 frame(1.0f);
  while ((bone = skeleton.parents[static_cast<std::size_t>(bone)]) >= 0) {
    frame = glm::mat3(to_matrix(pose[static_cast<std::size_t>(bone)])) * frame;
  }
  return frame;
}

}  // namespace

const ClipChannel* find_travelling_root(const Clip& clip, const Skeleton& skeleton) {
  const ClipChannel* root = nullptr;
  int root_depth = std::numeric_limits<int>::max();
  for (const ClipChannel& channel : clip.channels) {
    if (channel.target != ClipTarget::kTranslation || channel.key_count == 0) continue;
    if (channel.bone < 0 || static_cast<std::size_t>(channel.bone) >= skeleton.size()) continue;
    const int depth = depth_of(skeleton, channel.bone);
    if (depth > root_depth || (depth == root_depth && channel.bone >= root->bone)) continue;
    if (!moves(clip, channel)) continue;
    root = &channel;
    root_depth = depth;
  }
  return root;
}

void hold_in_place(const Clip& clip, const Skeleton& skeleton, float time, std::span<Trs> pose) {
  if (pose.size() != skeleton.size() || !(clip.duration() > 0.0f)) return;
  const ClipChannel* root = find_travelling_root(clip, skeleton);
  if (root == nullptr) return;
  const glm::vec3 drift = key_value(clip, *root, root->key_count - 1) - key_value(clip, *root, 0);
  if (drift == glm::vec3(0.0f)) return;
  const glm::mat3 to_character = frame_above(skeleton, root->bone, pose);
  const glm::vec3 travelled = to_character * drift;
  if (travelled.x == 0.0f && travelled.z == 0.0f) return;
  const float determinant = glm::determinant(to_character);
  if (!(std::abs(determinant) > kLeastDeterminant) || !std::isfinite(determinant)) return;
  const glm::vec3 level = glm::inverse(to_character) * glm::vec3(travelled.x, 0.0f, travelled.z);
  // As in sample_clip, a time that is not finite means the start.
  const float fraction =
      std::isfinite(time) ? std::clamp((time - clip.start) / clip.duration(), 0.0f, 1.0f) : 0.0f;
  pose[static_cast<std::size_t>(root->bone)].translation -= fraction * level;
}

}  // namespace fascicle
