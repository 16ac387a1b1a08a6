// Nodes become bones, parents first; skins refer to them.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

#include "engine/content/gltf_accessors.hpp"
#include "engine/content/gltf_source.hpp"

namespace fascicle::detail {
namespace {

constexpr float kTolerance = 1e-3f;  // of unit quaternions and orthogonal axes

std::string node_path(std::size_t node) { return fmt::format("/nodes/{}", node); }

glm::vec3 to_vec3(const std::vector<double>& v) {
  return {static_cast<float>(v[0]), static_cast<float>(v[1]), static_cast<float>(v[2])};
}

// A matrix as translation, rotation and scale. A mirroring one gets a negative x scale; shear is lost, with a warning.
Trs decompose(GltfSource& source, std::size_t node, const std::vector<double>& values) {
  glm::mat4 matrix;
  for (int c = 0; c < 4; ++c) {
    for (int r = 0; r < 4; ++r) matrix[c][r] = static_cast<float>(values[static_cast<std::size_t>(4 * c + r)]);
  }
  const std::string path = node_path(node) + "/matrix";
  if (matrix[0][3] != 0.0f || matrix[1][3] != 0.0f || matrix[2][3] != 0.0f || matrix[3][3] != 1.0f) {
    source.error(path, "the last row is not 0, 0, 0, 1", "write an affine matrix, column by column");
    return {};
  }
  Trs trs;
  trs.translation = glm::vec3(matrix[3]);
  glm::mat3 axes(matrix);
  for (int c = 0; c < 3; ++c) trs.scale[c] = glm::length(axes[c]);
  if (!(glm::dot(trs.scale, trs.scale) < 1e30f)) {
    source.error(path, "numbers too large", "write a matrix of translation, rotation and scale");
    return {};
  }
  if (trs.scale.x == 0.0f || trs.scale.y == 0.0f || trs.scale.z == 0.0f) return trs;  // flattened: no rotation to find
  if (glm::determinant(axes) < 0.0f) trs.scale.x = -trs.scale.x;
  for (int c = 0; c < 3; ++c) axes[c] /= trs.scale[c];
  const float skew = std::max({std::abs(glm::dot(axes[0], axes[1])), std::abs(glm::dot(axes[1], axes[2])),
                               std::abs(glm::dot(axes[2], axes[0]))});
  if (skew > kTolerance)
    source.warning(path, "the matrix shears; the shear is left out", "use translation, rotation and scale");
  // Orthonormal axes give a unit quaternion; sheared ones at least a finite one.
  const glm::vec3 x = axes[0];
  glm::vec3 y = axes[1] - glm::dot(axes[1], x) * x;
  const float length = glm::length(y);
  if (!(length > kTolerance)) return trs;
  y /= length;
  trs.rotation = glm::normalize(glm::quat_cast(glm::mat3(x, y, glm::cross(x, y))));
  return trs;
}

Trs read_transform(GltfSource& source, std::size_t index) {
  const tinygltf::Node& node = source.model.nodes[index];
  if (!node.matrix.empty()) return decompose(source, index, node.matrix);
  Trs trs;
  if (!node.translation.empty()) trs.translation = to_vec3(node.translation);
  if (!node.scale.empty()) trs.scale = to_vec3(node.scale);
  if (!node.rotation.empty()) {
    const glm::quat rotation(static_cast<float>(node.rotation[3]), to_vec3(node.rotation));
    const float length = glm::length(rotation);
    if (!(std::abs(length - 1.0f) < kTolerance)) {
      source.error(node_path(index) + "/rotation", fmt::format("a quaternion of length {:.4g}", length),
                   "write a unit quaternion x, y, z, w");
      return trs;
    }
    trs.rotation = rotation / length;
  }
  return trs;
}

// The parent of each node, -1 for roots; nothing after an error.
std::optional<std::vector<std::int32_t>> find_parents(GltfSource& source) {
  const std::vector<tinygltf::Node>& nodes = source.model.nodes;
  std::vector<std::int32_t> parents(nodes.size(), -1);
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    for (std::size_t k = 0; k < nodes[i].children.size(); ++k) {
      const auto child = static_cast<std::size_t>(nodes[i].children[k]);
      if (parents[child] >= 0) {
        source.error(fmt::format("/nodes/{}/children/{}", i, k),
                     fmt::format("node {} is a child of node {} already", child, parents[child]),
                     "a node has one parent: remove it from one of them");
        continue;
      }
      parents[child] = static_cast<std::int32_t>(i);
    }
  }
  if (!source.ok()) return std::nullopt;
  return parents;
}

// Node indices, each after its parent, else in the order of the file; fewer than all when there are cycles.
std::vector<std::int32_t> order_nodes(const std::vector<tinygltf::Node>& nodes,
                                      const std::vector<std::int32_t>& parents) {
  std::vector<std::int32_t> order, stack;
  for (std::size_t root = 0; root < nodes.size(); ++root) {
    if (parents[root] >= 0) continue;
    stack.push_back(static_cast<std::int32_t>(root));
    while (!stack.empty()) {
      const std::int32_t node = stack.back();
      stack.pop_back();
      order.push_back(node);
      const std::vector<int>& children = nodes[static_cast<std::size_t>(node)].children;
      stack.insert(stack.end(), children.rbegin(), children.rend());
    }
  }
  return order;
}

bool all_finite(const glm::mat4& matrix) {
  for (int c = 0; c < 4; ++c) {
    for (int r = 0; r < 4; ++r) {
      if (!std::isfinite(matrix[c][r])) return false;
    }
  }
  return true;
}

}  // namespace

void convert_nodes(GltfSource& source, GltfFile& out) {
  const std::vector<tinygltf::Node>& nodes = source.model.nodes;
  const auto parents = find_parents(source);
  if (!parents) return;
  const std::vector<std::int32_t> order = order_nodes(nodes, *parents);
  out.node_bones.assign(nodes.size(), -1);
  for (std::size_t bone = 0; bone < order.size(); ++bone)
    out.node_bones[static_cast<std::size_t>(order[bone])] = static_cast<std::int32_t>(bone);
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    if (out.node_bones[i] < 0)
      source.error(node_path(i), "the node is, through its children, its own ancestor, or below one that is",
                   "remove the loop");
  }
  if (!source.ok()) return;

  UniqueNames names;
  Skeleton& skeleton = out.skeleton;
  for (const std::int32_t node : order) {
    const auto index = static_cast<std::size_t>(node);
    const std::int32_t parent = (*parents)[index];
    skeleton.names.push_back(names.take(nodes[index].name, fmt::format("node_{}", index)));
    skeleton.parents.push_back(parent < 0 ? -1 : out.node_bones[static_cast<std::size_t>(parent)]);
    skeleton.rest_local.push_back(read_transform(source, index));
    const glm::mat4 local = to_matrix(skeleton.rest_local.back());
    const std::int32_t above = skeleton.parents.back();
    skeleton.rest_world.push_back(above < 0 ? local : skeleton.rest_world[static_cast<std::size_t>(above)] * local);
    if (!all_finite(skeleton.rest_world.back())) {
      source.error(node_path(index), "the transforms down to this node grow beyond all numbers",
                   "correct its scale or translation, or those above it");
    }
  }
}

void convert_skins(GltfSource& source, GltfFile& out) {
  UniqueNames names;
  for (std::size_t s = 0; s < source.model.skins.size(); ++s) {
    const tinygltf::Skin& from = source.model.skins[s];
    const std::string path = fmt::format("/skins/{}", s);
    GltfSkin skin;
    skin.name = names.take(from.name, fmt::format("skin_{}", s));
    for (const int joint : from.joints) skin.bones.push_back(out.node_bones[static_cast<std::size_t>(joint)]);
    if (skin.bones.empty()) source.error(path + "/joints", "no joints", "name at least one");
    if (skin.bones.size() > 65536)
      source.error(path + "/joints", fmt::format("{} joints", skin.bones.size()), "use at most 65536");
    skin.inverse_binds.assign(skin.bones.size(), glm::mat4(1.0f));
    if (from.inverseBindMatrices >= 0) {
      std::vector<float> values;
      const auto count =
          read_float_accessor(source, from.inverseBindMatrices, 16, path + "/inverseBindMatrices", values);
      if (count && *count < skin.bones.size()) {
        source.error(path + "/inverseBindMatrices", fmt::format("{} matrices for {} joints", *count, skin.bones.size()),
                     "store one a joint");
      } else if (count) {
        for (std::size_t j = 0; j < skin.bones.size(); ++j) {
          for (int k = 0; k < 16; ++k)
            skin.inverse_binds[j][k / 4][k % 4] = values[16 * j + static_cast<std::size_t>(k)];
        }
      }
    }
    out.skins.push_back(std::move(skin));
  }
}

}  // namespace fascicle::detail
