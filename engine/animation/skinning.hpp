// Linear blend skinning on the CPU: a mesh whose vertices follow up to four bones each.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include <glm/gtc/type_precision.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "engine/animation/skeleton.hpp"

namespace fascicle {

// Immutable, shared by all characters that wear it.
struct SkinAsset {
  std::string name;
  std::vector<glm::vec3> positions;       // m, bind space
  std::vector<glm::vec3> normals;         // unit
  std::vector<std::uint32_t> indices;     // three a triangle
  std::vector<glm::u16vec4> joints;       // indices into the two arrays below
  std::vector<glm::vec4> weights;         // sum 1
  std::vector<std::int32_t> joint_bones;  // joint -> bone of the skeleton
  std::vector<glm::mat4> inverse_binds;   // bind space -> joint's frame
  glm::vec4 base_colour{1.0f};            // linear RGBA

  std::size_t size() const { return positions.size(); }
};

// Component: the skinned vertices, in world space. Sized at spawn by make_skinned_surface.
struct SkinnedSurface {
  std::vector<glm::vec3> positions;       // m
  std::vector<glm::vec3> normals;         // unit
  std::vector<glm::mat4> joint_matrices;  // bind space -> world, of the current frame
};
SkinnedSurface make_skinned_surface(const SkinAsset& asset);
inline std::size_t heap_bytes(const SkinnedSurface& surface) {
  return (surface.positions.capacity() + surface.normals.capacity()) * sizeof(glm::vec3) +
         surface.joint_matrices.capacity() * sizeof(glm::mat4);
}

// joint_matrices[j] = world[joint_bones[j]] * inverse_binds[j].
void compute_joint_matrices(const SkinAsset& asset, std::span<const glm::mat4> world,
                            std::span<glm::mat4> joint_matrices);

// Skins vertices [first, last) into the same places of `positions` and `normals`. Normals use the blended matrix's
// upper 3x3 part, which is exact for rigid bones with uniform scale.
void skin_vertices(const SkinAsset& asset, std::span<const glm::mat4> joint_matrices, std::size_t first,
                   std::size_t last, std::span<glm::vec3> positions, std::span<glm::vec3> normals);

// The same in plain GLM, one vertex after another: what the fast one is tested and measured against.
void skin_vertices_reference(const SkinAsset& asset, std::span<const glm::mat4> joint_matrices, std::size_t first,
                             std::size_t last, std::span<glm::vec3> positions, std::span<glm::vec3> normals);

}  // namespace fascicle
