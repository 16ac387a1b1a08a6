// The files that one load reads: resolves the paths of content files, reads each file once, and remembers every path
// for the watcher, missing ones too, so that putting the file there is noticed.
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/content/json_reader.hpp"
#include "engine/content/result.hpp"

namespace fascicle {
struct GltfFile;
struct TriangleMesh;
}  // namespace fascicle

namespace fascicle::muscle {

// How the cause of an error starts where content needs the data folder and there is none.
inline constexpr std::string_view kNoDataFolder = "there is no data folder";

class ContentSources {
 public:
  // `data_folder` is what `data:` stands for; empty: find_data_folder().
  explicit ContentSources(std::filesystem::path data_folder);

  const std::filesystem::path& data_folder() const { return data_folder_; }
  // In order of first use, each once.
  const std::vector<std::filesystem::path>& files() const { return files_; }
  void note(const std::filesystem::path& file);

  // `reference` as written at `node`, relative to `base` or after `data:`. Errors: no data folder, no such file (the
  // nearest name in its folder is suggested), a folder. The path is noted in any case.
  std::optional<std::filesystem::path> resolve(const std::string& reference, const std::filesystem::path& base,
                                               const JsonNode& node, Diagnostics& diagnostics);

  // Null where the file is missing or wrong; its errors are appended the first time only.
  std::shared_ptr<const GltfFile> gltf(const std::string& reference, const std::filesystem::path& base,
                                       const JsonNode& node, Diagnostics& diagnostics);

  // A file of one of read_mesh's formats, or "FILE.glb#NAME" (#NAME may be left out where the file has one mesh), in
  // the file's rest space and unit.
  std::shared_ptr<const TriangleMesh> mesh(const std::string& reference, const std::filesystem::path& base,
                                           const JsonNode& node, Diagnostics& diagnostics);

 private:
  std::filesystem::path data_folder_;
  std::vector<std::filesystem::path> files_;
  std::map<std::filesystem::path, std::shared_ptr<const GltfFile>> gltf_files_;   // null: read and wrong
  std::map<std::string, std::shared_ptr<const TriangleMesh>> meshes_;             // by path and name; null: wrong
};

// A mesh of `file`, vertices taken to the file's rest space.
std::shared_ptr<const TriangleMesh> rest_space_mesh(const GltfFile& file, std::size_t mesh);

}  // namespace fascicle::muscle
