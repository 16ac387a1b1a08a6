// A character's bone hierarchy at rest, shared by all characters that use it, and the per-character pose components.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <glm/gtc/quaternion.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

namespace fascicle {

// Translation (m), rotation (unit quaternion) and scale, applied scale first.
struct Trs {
  glm::vec3 translation{0.0f};
  glm::quat rotation{1.0f, 0.0f, 0.0f, 0.0f};
  glm::vec3 scale{1.0f};
};
inline glm::mat4 to_matrix(const Trs& trs) {
  glm::mat4 matrix = glm::mat4_cast(trs.rotation);
  matrix[0] *= trs.scale.x;
  matrix[1] *= trs.scale.y;
  matrix[2] *= trs.scale.z;
  matrix[3] = glm::vec4(trs.translation, 1.0f);
  return matrix;
}

struct Skeleton {
  std::vector<std::string> names;
  std::vector<std::int32_t> parents;    // -1 for a root; a parent always stands before its children
  std::vector<Trs> rest_local;          // to the parent
  std::vector<glm::mat4> rest_world;    // to the character's space

  std::size_t size() const { return names.size(); }
  // The bone's index, or -1.
  std::int32_t find(std::string_view name) const;
};

// Where the character stands in the world; its size is a matter of content. `teleport_count` rises with every jump that
// must not be interpolated over.
struct Placement {
  glm::vec3 position{0.0f};
  glm::quat rotation{1.0f, 0.0f, 0.0f, 0.0f};
  std::uint32_t teleport_count = 0;
};

// Component: the current pose relative to each bone's parent. Written by an animation system.
struct LocalPose {
  std::shared_ptr<const Skeleton> skeleton;
  std::vector<Trs> bones;
};

// Component: the current bone transforms, bone to world. Written by `compose_bones`, or by a host engine that brings
// its own animation: this is all that the muscle module needs of a character.
// Each matrix must be rigid relative to the rest pose that the muscles were built with: world * inverse(rest_world)
// turns and moves but does not scale, since radii and tendon lengths (m) are fixed when a muscle is built. A character
// of another size is other content: scale its skeleton's rest pose, skin and muscles, not its placement.
struct BoneMatrices {
  std::vector<glm::mat4> world;
  std::uint32_t teleport_count = 0;
  std::uint64_t held_steps = 0;      // steps in which `compose_bones` kept `world`, since the pose was not usable
  std::vector<glm::mat4> next = {};  // scratch of `compose_bones`: the step's matrices until they are known to be sound
};

// No entry of a usable bone matrix is larger: muscles and skins hold their last shape beyond it.
inline constexpr float kLargestMatrixEntry = 1.0e5f;

// Whether no entry is NaN, infinite or beyond kLargestMatrixEntry.
bool are_usable(std::span<const glm::mat4> matrices);

// Bone to the space that `root` leads to: world[i] = world[parent] * local[i], a root's parent being `root`.
// All three spans have the skeleton's size.
void compose(const Skeleton& skeleton, std::span<const Trs> local, const glm::mat4& root, std::span<glm::mat4> world);

// The matrix of a placement: character's space to world.
glm::mat4 to_matrix(const Placement& placement);

// A pose at rest, with room for all bones.
LocalPose make_rest_pose(std::shared_ptr<const Skeleton> skeleton);

// What they own on the heap, for the statistics; the shared skeleton is nobody's own.
inline std::size_t heap_bytes(const LocalPose& pose) { return pose.bones.capacity() * sizeof(Trs); }
inline std::size_t heap_bytes(const BoneMatrices& bones) {
  return (bones.world.capacity() + bones.next.capacity()) * sizeof(glm::mat4);
}

}  // namespace fascicle
