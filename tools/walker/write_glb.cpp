#include "tools/walker/write_glb.hpp"

#include <cstring>
#include <span>

#include <glm/mat4x4.hpp>
#include <tiny_gltf.h>

#include "tools/walker/skeleton.hpp"

namespace fascicle::walker {
namespace {

tinygltf::Model empty_model() {
  tinygltf::Model model;
  model.asset.version = "2.0";
  model.asset.generator = "fascicle-make-walker";
  model.buffers.emplace_back();
  model.scenes.emplace_back();
  model.defaultScene = 0;
  return model;
}

// Appends `data` as an accessor of its own buffer view.
template <class T>
int add_accessor(tinygltf::Model& model, std::span<const T> data, int component, int type, int components, int target) {
  std::vector<unsigned char>& bytes = model.buffers[0].data;
  while (bytes.size() % 4 != 0) bytes.push_back(0);
  tinygltf::BufferView view;
  view.buffer = 0;
  view.byteOffset = bytes.size();
  view.byteLength = data.size_bytes();
  view.target = target;
  const auto* first = reinterpret_cast<const unsigned char*>(data.data());
  bytes.insert(bytes.end(), first, first + data.size_bytes());
  model.bufferViews.push_back(view);
  tinygltf::Accessor accessor;
  accessor.bufferView = static_cast<int>(model.bufferViews.size()) - 1;
  accessor.componentType = component;
  accessor.type = type;
  accessor.count = data.size() / static_cast<std::size_t>(components);
  model.accessors.push_back(accessor);
  return static_cast<int>(model.accessors.size()) - 1;
}

int add_vec3(tinygltf::Model& model, const std::vector<glm::vec3>& data, bool bounds, int target) {
  const std::span<const float> floats(&data[0].x, data.size() * 3);
  const int index = add_accessor(model, floats, TINYGLTF_COMPONENT_TYPE_FLOAT, TINYGLTF_TYPE_VEC3, 3, target);
  if (!bounds) return index;
  glm::vec3 low = data[0], high = data[0];
  for (const glm::vec3& p : data) {
    low = glm::min(low, p);
    high = glm::max(high, p);
  }
  model.accessors.back().minValues = {low.x, low.y, low.z};
  model.accessors.back().maxValues = {high.x, high.y, high.z};
  return index;
}

int add_mesh(tinygltf::Model& model, const TriangleMesh& mesh) {
  tinygltf::Primitive primitive;
  primitive.mode = TINYGLTF_MODE_TRIANGLES;
  primitive.attributes["POSITION"] = add_vec3(model, mesh.positions, true, TINYGLTF_TARGET_ARRAY_BUFFER);
  if (!mesh.normals.empty())
    primitive.attributes["NORMAL"] = add_vec3(model, mesh.normals, false, TINYGLTF_TARGET_ARRAY_BUFFER);
  const std::vector<std::uint16_t> narrow(mesh.indices.begin(), mesh.indices.end());
  primitive.indices = mesh.positions.size() < 65535
                          ? add_accessor(model, std::span(narrow), TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT,
                                         TINYGLTF_TYPE_SCALAR, 1, TINYGLTF_TARGET_ELEMENT_ARRAY_BUFFER)
                          : add_accessor(model, std::span(mesh.indices), TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT,
                                         TINYGLTF_TYPE_SCALAR, 1, TINYGLTF_TARGET_ELEMENT_ARRAY_BUFFER);
  tinygltf::Mesh out;
  out.name = mesh.name;
  out.primitives.push_back(primitive);
  model.meshes.push_back(out);
  return static_cast<int>(model.meshes.size()) - 1;
}

bool write(tinygltf::Model& model, const std::filesystem::path& file) {
  tinygltf::TinyGLTF writer;
  return writer.WriteGltfSceneToFile(&model, file.string(), true, true, false, true);
}

void add_skeleton(tinygltf::Model& model) {
  for (std::size_t i = 0; i < bones().size(); ++i) {
    const Bone& bone = bones()[i];
    tinygltf::Node node;
    node.name = bone.name;
    node.translation = {bone.offset.x, bone.offset.y, bone.offset.z};
    for (std::size_t child = 0; child < bones().size(); ++child)
      if (bones()[child].parent == static_cast<int>(i)) node.children.push_back(static_cast<int>(child));
    model.nodes.push_back(node);
  }
}

void add_skin(tinygltf::Model& model, const Skin& skin) {
  const int mesh = add_mesh(model, skin.mesh);
  tinygltf::Primitive& primitive = model.meshes.back().primitives.back();
  primitive.attributes["JOINTS_0"] =
      add_accessor(model, std::span<const std::uint8_t>(skin.joints[0].data(), skin.joints.size() * 4),
                   TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE, TINYGLTF_TYPE_VEC4, 4, TINYGLTF_TARGET_ARRAY_BUFFER);
  primitive.attributes["WEIGHTS_0"] =
      add_accessor(model, std::span<const float>(skin.weights[0].data(), skin.weights.size() * 4),
                   TINYGLTF_COMPONENT_TYPE_FLOAT, TINYGLTF_TYPE_VEC4, 4, TINYGLTF_TARGET_ARRAY_BUFFER);
  std::vector<float> inverse;
  tinygltf::Skin binding;
  binding.name = "skin";
  for (std::size_t i = 0; i < bones().size(); ++i) {
    const glm::vec3 p = bones()[i].place;
    const float matrix[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, -p.x, -p.y, -p.z, 1};
    inverse.insert(inverse.end(), matrix, matrix + 16);
    binding.joints.push_back(static_cast<int>(i));
  }
  binding.skeleton = 0;
  binding.inverseBindMatrices =
      add_accessor(model, std::span<const float>(inverse), TINYGLTF_COMPONENT_TYPE_FLOAT, TINYGLTF_TYPE_MAT4, 16, 0);
  model.skins.push_back(binding);
  tinygltf::Node node;
  node.name = "skin";
  node.mesh = mesh;
  node.skin = 0;
  model.nodes.push_back(node);
}

void add_clip(tinygltf::Model& model, const Gait& gait) {
  tinygltf::Animation clip;
  clip.name = "walk";
  const int times = add_accessor(model, std::span<const float>(gait.times), TINYGLTF_COMPONENT_TYPE_FLOAT,
                                 TINYGLTF_TYPE_SCALAR, 1, 0);
  model.accessors[static_cast<std::size_t>(times)].minValues = {gait.times.front()};
  model.accessors[static_cast<std::size_t>(times)].maxValues = {gait.times.back()};
  const auto add_channel = [&](std::size_t bone, const char* path, int output) {
    tinygltf::AnimationSampler sampler;
    sampler.input = times;
    sampler.output = output;
    sampler.interpolation = "LINEAR";
    clip.samplers.push_back(sampler);
    tinygltf::AnimationChannel channel;
    channel.sampler = static_cast<int>(clip.samplers.size()) - 1;
    channel.target_node = static_cast<int>(bone);
    channel.target_path = path;
    clip.channels.push_back(channel);
  };
  for (std::size_t bone = 0; bone < bones().size(); ++bone) {
    bool turns = false, moves = false;
    std::vector<float> rotations;
    std::vector<glm::vec3> translations;
    for (const Pose& pose : gait.poses) {
      const glm::quat q = pose.rotation[bone];
      rotations.insert(rotations.end(), {q.x, q.y, q.z, q.w});
      translations.push_back(pose.translation[bone]);
      turns = turns || q.w < 0.9999999f;
      moves = moves || pose.translation[bone] != bones()[bone].offset;
    }
    if (turns)
      add_channel(bone, "rotation",
                  add_accessor(model, std::span<const float>(rotations), TINYGLTF_COMPONENT_TYPE_FLOAT,
                               TINYGLTF_TYPE_VEC4, 4, 0));
    if (moves) add_channel(bone, "translation", add_vec3(model, translations, false, 0));
  }
  model.animations.push_back(clip);
}

}  // namespace

bool write_meshes(const std::filesystem::path& file, const std::vector<TriangleMesh>& meshes) {
  tinygltf::Model model = empty_model();
  for (const TriangleMesh& mesh : meshes) {
    tinygltf::Node node;
    node.name = mesh.name;
    node.mesh = add_mesh(model, mesh);
    model.scenes[0].nodes.push_back(static_cast<int>(model.nodes.size()));
    model.nodes.push_back(node);
  }
  return write(model, file);
}

bool write_walker(const std::filesystem::path& file, const Skin& skin, const Gait& gait) {
  tinygltf::Model model = empty_model();
  add_skeleton(model);
  add_skin(model, skin);
  add_clip(model, gait);
  model.scenes[0].nodes = {0, static_cast<int>(model.nodes.size()) - 1};
  return write(model, file);
}

}  // namespace fascicle::walker
