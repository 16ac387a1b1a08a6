#include "engine/animation/skinning.hpp"

#include <cassert>
#include <cmath>
#include <cstring>

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>

namespace fascicle {
namespace {

// Four floats in one SSE register: the column of a matrix.
using Float4 = float __attribute__((vector_size(16)));

Float4 load(const float* from) {
  Float4 value;
  std::memcpy(&value, from, sizeof value);
  return value;
}

glm::vec3 to_vec3(Float4 v) { return {v[0], v[1], v[2]}; }

// A blend of turned normals can vanish; any unit vector is then as good, and finite.
glm::vec3 normalised(const glm::vec3& v) {
  const float squared = glm::dot(v, v);
  if (!(squared > 1e-30f && std::isfinite(squared))) return {0.0f, 0.0f, 1.0f};
  return v * (1.0f / std::sqrt(squared));
}

}  // namespace

SkinnedSurface make_skinned_surface(const SkinAsset& asset) {
  return {asset.positions, asset.normals, std::vector<glm::mat4>(asset.joint_bones.size(), glm::mat4(1.0f))};
}

void compute_joint_matrices(const SkinAsset& asset, std::span<const glm::mat4> world,
                            std::span<glm::mat4> joint_matrices) {
  assert(joint_matrices.size() == asset.joint_bones.size());
  for (std::size_t j = 0; j < joint_matrices.size(); ++j) {
    joint_matrices[j] = world[static_cast<std::size_t>(asset.joint_bones[j])] * asset.inverse_binds[j];
  }
}

// Blending the matrices first (12 multiplications a bone) and transforming once is cheaper than transforming position
// and normal by every bone, and the columns fit the registers.
void skin_vertices(const SkinAsset& asset, std::span<const glm::mat4> joint_matrices, std::size_t first,
                   std::size_t last, std::span<glm::vec3> positions, std::span<glm::vec3> normals) {
  for (std::size_t i = first; i < last; ++i) {
    const glm::u16vec4 joints = asset.joints[i];
    const glm::vec4 weights = asset.weights[i];
    Float4 x{}, y{}, z{}, origin{};
    for (int k = 0; k < 4; ++k) {
      const float weight = weights[k];
      if (weight == 0.0f) continue;  // most vertices of most characters follow one or two bones
      const float* matrix = &joint_matrices[joints[k]][0][0];
      x += weight * load(matrix);
      y += weight * load(matrix + 4);
      z += weight * load(matrix + 8);
      origin += weight * load(matrix + 12);
    }
    const glm::vec3 p = asset.positions[i];
    const glm::vec3 n = asset.normals[i];
    positions[i] = to_vec3(x * p.x + y * p.y + z * p.z + origin);
    normals[i] = normalised(to_vec3(x * n.x + y * n.y + z * n.z));
  }
}

void skin_vertices_reference(const SkinAsset& asset, std::span<const glm::mat4> joint_matrices, std::size_t first,
                             std::size_t last, std::span<glm::vec3> positions, std::span<glm::vec3> normals) {
  for (std::size_t i = first; i < last; ++i) {
    glm::mat4 blended(0.0f);
    for (int k = 0; k < 4; ++k) blended += asset.weights[i][k] * joint_matrices[asset.joints[i][k]];
    positions[i] = glm::vec3(blended * glm::vec4(asset.positions[i], 1.0f));
    normals[i] = normalised(glm::mat3(blended) * asset.normals[i]);
  }
}

}  // namespace fascicle
