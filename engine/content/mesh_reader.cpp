#include "engine/content/mesh_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

#include "engine/content/closest_name.hpp"
#include "engine/content/gltf_reader.hpp"
#include "engine/content/vtp_reader.hpp"

namespace fascicle {
namespace {

constexpr std::string_view kSupported = "supported are .vtp, .glb and .gltf";

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

// Appends a mesh in the file's rest space. Skinned meshes stand in their bind space already, which is that space.
void append_mesh(const GltfFile& file, const GltfMesh& mesh, TriangleMesh& out) {
  const glm::mat4 to_file =
      mesh.skin >= 0 ? glm::mat4(1.0f) : file.skeleton.rest_world[static_cast<std::size_t>(mesh.bone)];
  const glm::mat3 linear(to_file);
  const bool mirrored = glm::determinant(linear) < 0.0f;
  const auto first = static_cast<std::uint32_t>(out.positions.size());
  for (const glm::vec3& p : mesh.geometry.positions) out.positions.push_back(glm::vec3(to_file * glm::vec4(p, 1.0f)));
  // The cofactor matrix turns normals also where the matrix has no inverse.
  const glm::mat3 cofactor(glm::cross(linear[1], linear[2]), glm::cross(linear[2], linear[0]),
                           glm::cross(linear[0], linear[1]));
  for (const glm::vec3& n : mesh.geometry.normals) {
    const glm::vec3 turned = (mirrored ? -1.0f : 1.0f) * (cofactor * n);
    const float length = glm::length(turned);
    out.normals.push_back(length > 0.0f ? turned / length : n);
  }
  const std::vector<std::uint32_t>& indices = mesh.geometry.indices;
  for (std::size_t i = 0; i + 2 < indices.size(); i += 3) {
    out.indices.push_back(first + indices[i]);
    out.indices.push_back(first + indices[mirrored ? i + 2 : i + 1]);
    out.indices.push_back(first + indices[mirrored ? i + 1 : i + 2]);
  }
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

Result<TriangleMesh> read_mesh(const std::string& file) {
  const MeshReference reference = split_mesh_reference(file);
  if (is_gltf(reference.file)) {
    const Result<GltfFile> gltf = read_gltf(reference.file);
    return gltf ? extract_mesh(*gltf, reference.name) : gltf.diagnostics();
  }
  if (lower_extension(reference.file) == ".vtp") return read_vtp(reference.file);
  return Diagnostic{file,
                    0,
                    0,
                    {},
                    fmt::format("unknown mesh format '{}'", reference.file.extension().string()),
                    std::string(kSupported)};
}

}  // namespace fascicle
