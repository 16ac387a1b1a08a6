#include "modules/muscle/content/content_sources.hpp"

#include <algorithm>
#include <system_error>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

#include "engine/content/closest_name.hpp"
#include "engine/content/gltf_reader.hpp"
#include "engine/content/mesh_reader.hpp"
#include "engine/content/triangle_mesh.hpp"
#include "modules/muscle/content/find_content.hpp"

namespace fascicle::muscle {

namespace {

namespace fs = std::filesystem;

constexpr std::string_view kDataPrefix = "data:";

// Names of the files in `folder`, sorted; at most 10,000.
std::vector<std::string> list_files(const fs::path& folder) {
  std::vector<std::string> names;
  std::error_code error;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error)) {
    if (names.size() == 10000) break;
    names.push_back(entry->path().filename().string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

std::string suggest_file(const fs::path& missing) {
  std::error_code error;
  const fs::path folder = missing.parent_path();
  if (!fs::is_directory(folder, error)) return fmt::format("the folder {} does not exist either", folder.string());
  const std::vector<std::string> names = list_files(folder);
  const std::string_view near = closest_name(missing.filename().string(), names);
  if (!near.empty()) return fmt::format("did you mean '{}'?", near);
  return fmt::format("put the file into {} or correct the path", folder.string());
}

std::string lower_extension(const fs::path& file) {
  std::string extension = file.extension().string();
  for (char& c : extension) c = static_cast<char>(c >= 'A' && c <= 'Z' ? c - 'A' + 'a' : c);
  return extension;
}

std::vector<std::string> mesh_names(const GltfFile& file) {
  std::vector<std::string> names;
  for (const GltfMesh& mesh : file.meshes) {
    names.push_back(mesh.name);
    if (!mesh.mesh_name.empty() && mesh.mesh_name != mesh.name) names.push_back(mesh.mesh_name);
  }
  return names;
}

}  // namespace

ContentSources::ContentSources(fs::path data_folder) : data_folder_(std::move(data_folder)) {
  if (data_folder_.empty()) data_folder_ = find_data_folder();
}

void ContentSources::note(const fs::path& file) {
  const fs::path normal = file.lexically_normal();
  if (std::find(files_.begin(), files_.end(), normal) == files_.end()) files_.push_back(normal);
}

std::optional<fs::path> ContentSources::resolve(const std::string& reference, const fs::path& base,
                                                const JsonNode& node, Diagnostics& diagnostics) {
  if (reference.empty()) {
    node.error(diagnostics, "the path is empty", "name a file, relative to this one or after data:");
    return std::nullopt;
  }
  fs::path path;
  if (reference.starts_with(kDataPrefix)) {
    std::error_code error;
    if (data_folder_.empty() || !fs::is_directory(data_folder_, error)) {
      node.error(diagnostics, fmt::format("{} for '{}'", kNoDataFolder, reference),
                 "set the environment variable FASCICLE_DATA to the folder that holds it");
      return std::nullopt;
    }
    path = data_folder_ / reference.substr(kDataPrefix.size());
  } else {
    path = base / reference;
  }
  path = path.lexically_normal();
  note(path);
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (fs::is_directory(status)) {
    node.error(diagnostics, fmt::format("'{}' is a folder ({})", reference, path.string()), "name a file in it");
    return std::nullopt;
  }
  if (!fs::exists(status)) {
    node.error(diagnostics, fmt::format("the file '{}' does not exist ({})", reference, path.string()),
               suggest_file(path));
    return std::nullopt;
  }
  if (!fs::is_regular_file(status)) {  // a pipe or a device could be read for ever
    node.error(diagnostics, fmt::format("'{}' is no ordinary file ({})", reference, path.string()), "name a file");
    return std::nullopt;
  }
  return path;
}

std::shared_ptr<const GltfFile> ContentSources::gltf(const std::string& reference, const fs::path& base,
                                                     const JsonNode& node, Diagnostics& diagnostics) {
  const std::optional<fs::path> path = resolve(reference, base, node, diagnostics);
  if (!path) return nullptr;
  if (const auto known = gltf_files_.find(*path); known != gltf_files_.end()) return known->second;
  if (const std::string extension = lower_extension(*path); extension != ".glb" && extension != ".gltf") {
    node.error(diagnostics, fmt::format("'{}' is not a glTF file", reference), "name a .glb or .gltf file");
    return nullptr;
  }
  Result<GltfFile> read = read_gltf(*path);
  std::shared_ptr<const GltfFile> file;
  if (read) file = std::make_shared<const GltfFile>(std::move(*read));
  diagnostics.append(std::move(read.diagnostics()));
  gltf_files_.emplace(*path, file);
  return file;
}

std::shared_ptr<const TriangleMesh> ContentSources::mesh(const std::string& reference, const fs::path& base,
                                                         const JsonNode& node, Diagnostics& diagnostics) {
  const MeshReference parts = split_mesh_reference(reference);
  const std::string extension = lower_extension(parts.file);
  if (extension == ".glb" || extension == ".gltf") {
    const std::shared_ptr<const GltfFile> file = gltf(parts.file.string(), base, node, diagnostics);
    if (!file) return nullptr;
    const GltfMesh* found = parts.name.empty() && file->meshes.size() == 1 ? &file->meshes.front()
                                                                            : file->find_mesh(parts.name);
    if (found == nullptr) {
      node.error(diagnostics,
                 parts.name.empty()
                     ? fmt::format("'{}' has {} meshes and none is named", reference, file->meshes.size())
                     : fmt::format("'{}' has no mesh '{}'", parts.file.string(), parts.name),
                 suggest_name(parts.name, mesh_names(*file), "meshes"));
      return nullptr;
    }
    std::shared_ptr<const TriangleMesh>& cached = meshes_[file->file + '#' + found->name];
    if (!cached) cached = rest_space_mesh(*file, static_cast<std::size_t>(found - file->meshes.data()));
    return cached;
  }
  if (!is_mesh_file(parts.file)) {
    node.error(diagnostics, fmt::format("'{}' is of no known mesh format", reference),
               "name a .vtk, .vtp, .obj, .ply or .stl file, or a mesh in a .glb as FILE.glb#NAME");
    return nullptr;
  }
  const std::optional<fs::path> path = resolve(reference, base, node, diagnostics);
  if (!path) return nullptr;
  if (const auto known = meshes_.find(path->string()); known != meshes_.end()) return known->second;
  Result<TriangleMesh> read = read_mesh(path->string());
  std::shared_ptr<const TriangleMesh> mesh;
  if (read) mesh = std::make_shared<const TriangleMesh>(std::move(*read));
  diagnostics.append(std::move(read.diagnostics()));
  meshes_.emplace(path->string(), mesh);
  return mesh;
}

std::shared_ptr<const TriangleMesh> rest_space_mesh(const GltfFile& file, std::size_t index) {
  const GltfMesh& source = file.meshes[index];
  auto mesh = std::make_shared<TriangleMesh>(source.geometry);
  mesh->name = source.name;
  if (source.skin >= 0 || source.bone < 0) return mesh;  // a skinned mesh stands in the bind space already
  const glm::mat4& rest = file.skeleton.rest_world[static_cast<std::size_t>(source.bone)];
  const glm::mat3 normal_matrix = glm::transpose(glm::inverse(glm::mat3(rest)));
  for (glm::vec3& position : mesh->positions) position = glm::vec3(rest * glm::vec4(position, 1.0f));
  for (glm::vec3& normal : mesh->normals) {
    const glm::vec3 turned = normal_matrix * normal;
    const float length = glm::length(turned);
    if (length > 0.0f) normal = turned / length;
  }
  return mesh;
}

}  // namespace fascicle::muscle
