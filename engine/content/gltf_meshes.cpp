// Meshes: the triangle primitives of one mesh joined, with normals and four influences a vertex.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include <glm/geometric.hpp>

#include "engine/content/gltf_accessors.hpp"
#include "engine/content/gltf_source.hpp"

namespace fascicle::detail {
namespace {

constexpr int kMaxInfluenceSets = 8;  // JOINTS_0 .. JOINTS_7

struct ConvertedMesh {
  bool done = false;
  TriangleMesh geometry;
  std::vector<glm::u16vec4> joints;
  std::vector<glm::vec4> weights;
  bool has_influences = true;     // all primitives have them
  std::uint32_t joint_limit = 0;  // one above the largest joint
  glm::vec4 base_colour{1.0f};
};

glm::vec3 vec3_at(const std::vector<float>& values, std::size_t i) {
  return {values[3 * i], values[3 * i + 1], values[3 * i + 2]};
}

// Fills in the normals that are missing or have no length, as the area-weighted mean of the triangles around.
void complete_normals(std::span<const glm::vec3> positions, std::span<const std::uint32_t> indices,
                      std::span<glm::vec3> normals) {
  const auto usable = [](const glm::vec3& n) { return glm::dot(n, n) > 1e-12f && std::isfinite(glm::dot(n, n)); };
  if (!std::ranges::all_of(normals, usable)) {
    std::vector<glm::dvec3> sums(positions.size(), glm::dvec3(0.0));
    for (std::size_t t = 0; t + 2 < indices.size(); t += 3) {
      const glm::dvec3 a(positions[indices[t]]), b(positions[indices[t + 1]]), c(positions[indices[t + 2]]);
      const glm::dvec3 area = glm::cross(b - a, c - a);
      for (std::size_t k = 0; k < 3; ++k) sums[indices[t + k]] += area;
    }
    for (std::size_t i = 0; i < normals.size(); ++i) {
      if (usable(normals[i])) continue;
      const double length = glm::length(sums[i]);
      normals[i] = length > 0.0 && std::isfinite(length) ? glm::vec3(sums[i] / length) : glm::vec3(0.0f, 0.0f, 1.0f);
    }
  }
  for (glm::vec3& normal : normals) normal = glm::normalize(normal);
}

class PrimitiveReader {
 public:
  PrimitiveReader(GltfSource& source, const tinygltf::Primitive& primitive, std::string path, ConvertedMesh& out)
      : source_(source), primitive_(primitive), path_(std::move(path)), out_(out) {}

  void read() {
    if (primitive_.mode < TINYGLTF_MODE_TRIANGLES) {
      source_.warning(path_ + "/mode", "points and lines are left out", "only triangles are read");
      return;
    }
    if (!primitive_.targets.empty()) source_.warning(path_ + "/targets", "morph targets are left out", "use bones");
    if (!read_vertices()) return;
    read_triangles();
    if (!source_.ok()) return;
    const std::size_t first = first_vertex_;
    complete_normals(std::span(out_.geometry.positions).subspan(first), indices_,
                     std::span(out_.geometry.normals).subspan(first));
    for (const std::uint32_t index : indices_)
      out_.geometry.indices.push_back(static_cast<std::uint32_t>(first + index));
    read_influences();
  }

 private:
  int attribute(const std::string& name) const {
    const auto found = primitive_.attributes.find(name);
    return found == primitive_.attributes.end() ? -1 : found->second;
  }
  std::string attribute_path(const std::string& name) const { return path_ + "/attributes/" + name; }

  bool check_count(const std::string& name, std::optional<std::size_t> count) {
    if (!count) return false;
    if (*count == count_) return true;
    source_.error(attribute_path(name), fmt::format("{} elements for {} positions", *count, count_),
                  "store one a vertex");
    return false;
  }

  bool read_vertices() {
    first_vertex_ = out_.geometry.positions.size();
    if (attribute("POSITION") < 0) {
      source_.error(path_ + "/attributes", "no POSITION", "store the positions of the vertices");
      return false;
    }
    std::vector<float> values;
    const auto count = read_float_accessor(source_, attribute("POSITION"), 3, attribute_path("POSITION"), values, true);
    if (!count) return false;
    count_ = *count;
    for (std::size_t i = 0; i < count_; ++i) out_.geometry.positions.push_back(vec3_at(values, i));
    out_.geometry.normals.resize(out_.geometry.positions.size(), glm::vec3(0.0f));
    if (attribute("NORMAL") < 0) return true;
    if (!check_count("NORMAL",
                     read_float_accessor(source_, attribute("NORMAL"), 3, attribute_path("NORMAL"), values, true)))
      return false;
    for (std::size_t i = 0; i < count_; ++i) out_.geometry.normals[first_vertex_ + i] = vec3_at(values, i);
    return true;
  }

  void read_triangles() {
    std::vector<std::uint32_t> corners;
    if (primitive_.indices >= 0) {
      if (!read_index_accessor(source_, primitive_.indices, 1, path_ + "/indices", corners)) return;
      const auto bad = std::ranges::find_if(corners, [&](std::uint32_t corner) { return corner >= count_; });
      if (bad != corners.end()) {
        source_.error(fmt::format("/accessors/{}", primitive_.indices),
                      fmt::format("index {} is {}, but {} has {} vertices", bad - corners.begin(), *bad, path_, count_),
                      "correct the index");
        return;
      }
    } else {
      corners.resize(count_);
      for (std::size_t i = 0; i < count_; ++i) corners[i] = static_cast<std::uint32_t>(i);
    }
    const bool list = primitive_.mode == TINYGLTF_MODE_TRIANGLES;
    if (corners.size() < 3 || (list && corners.size() % 3 != 0)) {
      source_.error(path_, fmt::format("{} corners make no whole triangles", corners.size()),
                    list ? "give three corners a triangle" : "give at least three");
      return;
    }
    if (list) {
      indices_ = std::move(corners);
      return;
    }
    const bool strip = primitive_.mode == TINYGLTF_MODE_TRIANGLE_STRIP;
    for (std::size_t k = 2; k < corners.size(); ++k) {
      const bool odd = strip && k % 2 == 1;  // every other triangle of a strip turns the other way
      const std::uint32_t a = strip ? corners[k - 2] : corners[0], b = corners[k - 1], c = corners[k];
      if (a == b || b == c || c == a) continue;  // strips are joined by such
      indices_.insert(indices_.end(), {odd ? b : a, odd ? a : b, c});
    }
  }

  void read_influences() {
    std::array<std::vector<std::uint32_t>, kMaxInfluenceSets> joints;
    std::array<std::vector<float>, kMaxInfluenceSets> weights;
    std::size_t sets = 0;
    for (; sets < kMaxInfluenceSets; ++sets) {
      const std::string joint_name = fmt::format("JOINTS_{}", sets), weight_name = fmt::format("WEIGHTS_{}", sets);
      const bool has_joints = attribute(joint_name) >= 0, has_weights = attribute(weight_name) >= 0;
      if (!has_joints && !has_weights) break;
      if (has_joints != has_weights) {
        source_.error(
            path_ + "/attributes",
            fmt::format("{} without {}", has_joints ? joint_name : weight_name, has_joints ? weight_name : joint_name),
            "store both or neither");
        return;
      }
      if (!check_count(joint_name, read_index_accessor(source_, attribute(joint_name), 4, attribute_path(joint_name),
                                                       joints[sets], false)))
        return;
      if (!check_count(weight_name, read_float_accessor(source_, attribute(weight_name), 4, attribute_path(weight_name),
                                                        weights[sets])))
        return;
    }
    if (sets == 0) {
      out_.has_influences = false;
      out_.joints.resize(out_.geometry.positions.size(), glm::u16vec4(0));
      out_.weights.resize(out_.geometry.positions.size(), glm::vec4(1.0f, 0.0f, 0.0f, 0.0f));
      return;
    }
    bool weightless = false;
    for (std::size_t i = 0; i < count_; ++i) {
      if (!add_influences(i, {joints.data(), sets}, {weights.data(), sets}, weightless)) return;
    }
    if (weightless)
      source_.warning(attribute_path("WEIGHTS_0"), "some vertices have no weight",
                      "they follow the first joint; give each a weight");
  }

  bool add_influences(std::size_t vertex, std::span<const std::vector<std::uint32_t>> joints,
                      std::span<const std::vector<float>> weights, bool& weightless) {
    struct Influence {
      float weight = 0.0f;
      std::uint32_t joint = 0;
    };
    std::array<Influence, 4 * kMaxInfluenceSets> all;
    for (std::size_t k = 0; k < 4 * joints.size(); ++k) {
      const float weight = weights[k / 4][4 * vertex + k % 4];
      if (weight < 0.0f) {
        source_.error(attribute_path(fmt::format("WEIGHTS_{}", k / 4)),
                      fmt::format("vertex {} has the weight {}", vertex, weight), "weights are 0 to 1");
        return false;
      }
      all[k] = {weight, weight > 0.0f ? joints[k / 4][4 * vertex + k % 4] : 0};
    }
    std::ranges::stable_sort(all, [](const Influence& a, const Influence& b) { return a.weight > b.weight; });
    const float sum = all[0].weight + all[1].weight + all[2].weight + all[3].weight;
    glm::u16vec4 joint(0);
    glm::vec4 weight(1.0f, 0.0f, 0.0f, 0.0f);
    if (sum > 0.0f && std::isfinite(sum)) {
      for (int k = 0; k < 4; ++k) {
        const Influence& influence = all[static_cast<std::size_t>(k)];
        weight[k] = influence.weight / sum;
        joint[k] = static_cast<std::uint16_t>(influence.joint);
        out_.joint_limit = std::max(out_.joint_limit, influence.joint + 1);
      }
    } else {
      weightless = true;
    }
    out_.joints.push_back(joint);
    out_.weights.push_back(weight);
    return true;
  }

  GltfSource& source_;
  const tinygltf::Primitive& primitive_;
  std::string path_;
  ConvertedMesh& out_;
  std::size_t first_vertex_ = 0;
  std::size_t count_ = 0;
  std::vector<std::uint32_t> indices_;
};

glm::vec4 read_base_colour(const GltfSource& source, int material) {
  glm::vec4 colour(1.0f);
  if (material < 0) return colour;
  const JsonNode factor =
      source.document->nearest(fmt::format("/materials/{}/pbrMetallicRoughness/baseColorFactor", material));
  std::vector<float> numbers;
  Diagnostics ignored;  // the shape is checked
  if (factor.key() == "baseColorFactor" && factor.read(numbers, ignored))
    colour = {numbers[0], numbers[1], numbers[2], numbers[3]};
  return glm::clamp(colour, glm::vec4(0.0f), glm::vec4(1.0f));
}

void convert_mesh(GltfSource& source, std::size_t index, ConvertedMesh& out) {
  out.done = true;
  const std::vector<tinygltf::Primitive>& primitives = source.model.meshes[index].primitives;
  if (!primitives.empty()) out.base_colour = read_base_colour(source, primitives[0].material);
  for (std::size_t p = 0; p < primitives.size(); ++p) {
    PrimitiveReader(source, primitives[p], fmt::format("/meshes/{}/primitives/{}", index, p), out).read();
    if (!source.ok()) return;
  }
}

}  // namespace

void convert_meshes(GltfSource& source, GltfFile& out) {
  const tinygltf::Model& model = source.model;
  std::vector<std::int32_t> bone_nodes(out.skeleton.size());
  for (std::size_t node = 0; node < out.node_bones.size(); ++node)
    bone_nodes[static_cast<std::size_t>(out.node_bones[node])] = static_cast<std::int32_t>(node);

  std::vector<ConvertedMesh> converted(model.meshes.size());
  for (std::size_t bone = 0; bone < bone_nodes.size(); ++bone) {
    const auto node_index = static_cast<std::size_t>(bone_nodes[bone]);
    const tinygltf::Node& node = model.nodes[node_index];
    if (node.mesh < 0) continue;
    const auto mesh_index = static_cast<std::size_t>(node.mesh);
    ConvertedMesh& from = converted[mesh_index];
    const std::string path = fmt::format("/nodes/{}", node_index);
    if (!from.done) {
      convert_mesh(source, mesh_index, from);
    } else if (!source.spend(from.geometry.positions.size() + from.geometry.indices.size(), path + "/mesh")) {
      return;  // the same mesh again, under another node
    }
    if (from.geometry.indices.empty()) continue;  // nothing but lines, or errors
    GltfMesh mesh;
    mesh.name = out.skeleton.names[bone];
    mesh.mesh_name = model.meshes[mesh_index].name;
    mesh.bone = static_cast<std::int32_t>(bone);
    mesh.skin = node.skin;
    mesh.geometry = from.geometry;
    mesh.geometry.name = mesh.name;
    mesh.base_colour = from.base_colour;
    if (node.skin >= 0) {
      if (!from.has_influences) {
        source.error(fmt::format("/meshes/{}", mesh_index),
                     fmt::format("node {} skins it, but it lacks JOINTS_0 and WEIGHTS_0", node_index),
                     "store them, or remove the node's skin");
      }
      const std::size_t joint_count = out.skins[static_cast<std::size_t>(node.skin)].bones.size();
      if (from.joint_limit > joint_count) {
        source.error(
            fmt::format("/meshes/{}", mesh_index),
            fmt::format("a vertex follows joint {}, but skin {} has {}", from.joint_limit - 1, node.skin, joint_count),
            "correct JOINTS_0");
      }
      mesh.joints = from.joints;
      mesh.weights = from.weights;
    }
    out.meshes.push_back(std::move(mesh));
  }
}

}  // namespace fascicle::detail
