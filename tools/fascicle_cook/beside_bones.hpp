// Sections that lie beside a bone and stay there over the animation: where a tag with a bone has something to say.
//
// The other end of such a tag is the bone's point that is nearest at rest, and it stays on the bone. So the rules are:
// - No end section, and no vertex of the section within the bone at rest, as near attachments: it lies beside it.
// - The facing vertex is the one nearest to the bone at rest, and that near already.
// - In every pose the bone's point is in front of that vertex (less than the section's radius beside the way from the
//   vertex to the centre), else the two no longer belong together.
// - In no pose is it past the section's centre while that is outside of the bone: the tag would call the section back
//   for nothing.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

#include "tools/fascicle_cook/close_sections.hpp"

namespace fascicle::cook {

struct BesideBone {
  std::uint32_t section = 0, vertex = 0;
  std::int32_t bone = 0;
  glm::vec3 point{0.0f};  // m, the bone's nearest, in its frame
  float distance = 0.0f;  // m, the vertex's smallest so far, negative inside
  bool stays = true;      // so far
};

// At rest: bones where `rest` (by bone) puts them, `vertices` as in close_sections.
std::vector<BesideBone> find_beside_bones(const muscle::MuscleAsset& asset, std::uint32_t muscle,
                                          std::span<const glm::vec3> vertices,
                                          std::span<const std::unique_ptr<const Solid>> bones,
                                          std::span<const glm::mat4> rest, float near);

// Looks at them in one more pose.
void follow_beside_bones(const PosedMuscles& muscles, std::uint32_t muscle, std::span<const glm::vec3> vertices,
                         std::span<const std::unique_ptr<const Solid>> bones, std::span<const glm::mat4> matrices,
                         std::span<BesideBone> sections);

}  // namespace fascicle::cook
