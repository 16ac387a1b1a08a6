// glTF 2.0 characters (.gltf, .glb): node hierarchy, meshes, skins and animations, checked and turned into the engine's
// own types. Images are not read.
//
// Every node becomes a bone of one skeleton, parents first. Everything that the file says is checked before use: a
// value outside its bounds is an error that names the glTF path (/accessors/3), its cause and its remedy.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <glm/gtc/type_precision.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec4.hpp>

#include "engine/animation/clip.hpp"
#include "engine/animation/skeleton.hpp"
#include "engine/content/result.hpp"
#include "engine/content/triangle_mesh.hpp"

namespace fascicle {

// A mesh as one node carries it, all its triangle primitives joined.
struct GltfMesh {
  std::string name;                  // the node's name, which is unique
  std::string mesh_name;             // the mesh's own name, may be shared or empty
  std::int32_t bone = -1;            // the node. Without a skin the vertices are in its frame
  std::int32_t skin = -1;            // index into `skins`, or -1. With a skin the vertices are in the bind space
  TriangleMesh geometry;             // normals always present: computed where the file has none
  std::vector<glm::u16vec4> joints;  // indices into the skin's joints; empty without skin
  std::vector<glm::vec4> weights;    // sum 1; the four largest influences of those in the file
  glm::vec4 base_colour{1.0f};       // linear RGBA of the first primitive's material
};

struct GltfSkin {
  std::string name;
  std::vector<std::int32_t> bones;       // joint -> bone
  std::vector<glm::mat4> inverse_binds;  // bind space -> joint's frame
};

struct GltfFile {
  std::string file;
  Skeleton skeleton;                     // names unique: duplicates and empty ones get a number
  std::vector<std::int32_t> node_bones;  // glTF node index -> bone
  std::vector<GltfMesh> meshes;          // in order of their bones
  std::vector<GltfSkin> skins;
  std::vector<Clip> clips;

  // By node name, else by mesh name; nullptr when there is none.
  const GltfMesh* find_mesh(std::string_view name) const;
  const Clip* find_clip(std::string_view name) const;
};

Result<GltfFile> read_gltf(const std::filesystem::path& file);
// `bytes` is the text of a .gltf or a whole .glb. Buffers in files of their own are looked for in `base_folder`; an
// empty one refuses them.
Result<GltfFile> parse_gltf(std::span<const std::uint8_t> bytes, const std::filesystem::path& base_folder,
                            std::string file_name);

}  // namespace fascicle
