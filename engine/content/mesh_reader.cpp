#include "engine/content/mesh_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <utility>

#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

#include "engine/content/closest_name.hpp"
#include "engine/content/gltf_reader.hpp"
#include "engine/content/obj_reader.hpp"
#include "engine/content/ply_reader.hpp"
#include "engine/content/stl_reader.hpp"
#include "engine/content/vtk_reader.hpp"
#include "engine/content/vtp_reader.hpp"

namespace fascicle {
namespace {

constexpr std::string_view kSupported = "supported are .vtk, .vtp, .obj, .ply, .stl, .glb and .gltf";

using MeshReader = Result<TriangleMesh> (*)(const std::filesystem::path&);

std::string lower_extension(const std::filesystem::path& file) {
  std::string extension = file.extension().string();
  std::ranges::transform(extension, extension.begin(),
                         [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return extension;
}

bool is_gltf(const std::filesystem::path& file) {
  const std::string extension = lower_extension(file);
  return extension == ".glb" || extension == ".gltf";
}

// The reader of a file that holds one mesh; null where the extension is of no such format.
MeshReader find_reader(const std::filesystem::path& file) {
  static constexpr std::pair<std::string_view, MeshReader> kReaders[] = {
      {".vtk", read_vtk}, {".vtp", read_vtp}, {".obj", read_obj}, {".ply", read_ply}, {".stl", read_stl}};
  const std::string extension = lower_extension(file);
  for (const auto& [known, reader] : kReaders) {
    if (known == extension) return reader;
  }
  return nullptr;
}

// Appends a mesh in the file's rest space. Each vertex goes there by one matrix: that of the node, or the blend of its
// joints at rest.
class MeshAppender {
 public:
  MeshAppender(const GltfFile& file, const GltfMesh& mesh) : mesh_(mesh) {
    const auto rest = [&](std::int32_t bone) { return file.skeleton.rest_world[static_cast<std::size_t>(bone)]; };
    if (mesh.skin < 0) {
      matrices_.push_back(rest(mesh.bone));
      return;
    }
    const GltfSkin& skin = file.skins[static_cast<std::size_t>(mesh.skin)];
    for (std::size_t j = 0; j < skin.bones.size(); ++j)
      matrices_.push_back(rest(skin.bones[j]) * skin.inverse_binds[j]);
  }

  void append_to(TriangleMesh& out) const {
    const auto first = static_cast<std::uint32_t>(out.positions.size());
    const TriangleMesh& from = mesh_.geometry;
    for (std::size_t i = 0; i < from.positions.size(); ++i) append_vertex(i, out);
    const bool mirrored = mesh_.skin < 0 && glm::determinant(glm::mat3(matrices_[0])) < 0.0f;
    for (std::size_t i = 0; i + 2 < from.indices.size(); i += 3) {
      out.indices.push_back(first + from.indices[i]);
      out.indices.push_back(first + from.indices[mirrored ? i + 2 : i + 1]);
      out.indices.push_back(first + from.indices[mirrored ? i + 1 : i + 2]);
    }
  }

 private:
  void append_vertex(std::size_t i, TriangleMesh& out) const {
    glm::mat4 matrix(0.0f);
    if (mesh_.skin < 0) matrix = matrices_[0];
    for (int k = 0; mesh_.skin >= 0 && k < 4; ++k) matrix += mesh_.weights[i][k] * matrices_[mesh_.joints[i][k]];
    out.positions.push_back(glm::vec3(matrix * glm::vec4(mesh_.geometry.positions[i], 1.0f)));
    // The cofactor matrix turns normals also where the matrix has no inverse.
    const glm::mat3 m(matrix);
    const glm::mat3 cofactor(glm::cross(m[1], m[2]), glm::cross(m[2], m[0]), glm::cross(m[0], m[1]));
    const glm::vec3 normal = cofactor * mesh_.geometry.normals[i] * (glm::determinant(m) < 0.0f ? -1.0f : 1.0f);
    const float length = glm::length(normal);
    out.normals.push_back(length > 0.0f ? normal / length : mesh_.geometry.normals[i]);
  }

  const GltfMesh& mesh_;
  std::vector<glm::mat4> matrices_;
};

void append_mesh(const GltfFile& file, const GltfMesh& mesh, TriangleMesh& out) {
  MeshAppender(file, mesh).append_to(out);
}

}  // namespace

Result<TriangleMesh> extract_mesh(const GltfFile& file, const std::string& name) {
  TriangleMesh mesh;
  if (name.empty()) {
    mesh.name = std::filesystem::path(file.file).stem().string();
    for (const GltfMesh& each : file.meshes) append_mesh(file, each, mesh);
    if (mesh.indices.empty()) return Diagnostic{file.file, 0, 0, "/meshes", "no triangles", "is it the right file?"};
    return mesh;
  }
  const GltfMesh* found = file.find_mesh(name);
  if (found == nullptr) {
    std::vector<std::string> names;
    for (const GltfMesh& each : file.meshes) names.push_back(each.name);
    return Diagnostic{
        file.file, 0, 0, "/meshes", fmt::format("no mesh named '{}'", name), suggest_name(name, names, "meshes")};
  }
  mesh.name = name;
  append_mesh(file, *found, mesh);
  return mesh;
}

MeshReference split_mesh_reference(const std::string& reference) {
  const std::size_t hash = reference.rfind('#');
  if (hash == std::string::npos || !is_gltf(reference.substr(0, hash))) return {reference, {}};
  return {reference.substr(0, hash), reference.substr(hash + 1)};
}

bool is_mesh_file(const std::filesystem::path& file) { return is_gltf(file) || find_reader(file) != nullptr; }

Result<TriangleMesh> read_mesh(const std::string& file) {
  const MeshReference reference = split_mesh_reference(file);
  if (is_gltf(reference.file)) {
    const Result<GltfFile> gltf = read_gltf(reference.file);
    if (!gltf) return gltf.diagnostics();
    Result<TriangleMesh> mesh = extract_mesh(*gltf, reference.name);
    mesh.diagnostics().append(gltf.diagnostics());  // warnings
    return mesh;
  }
  if (const MeshReader reader = find_reader(reference.file)) return reader(reference.file);
  return Diagnostic{file,
                    0,
                    0,
                    {},
                    fmt::format("unknown mesh format '{}'", reference.file.extension().string()),
                    std::string(kSupported)};
}

}  // namespace fascicle
