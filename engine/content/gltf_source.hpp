// What the parts of the glTF reader share: the parsed model, the places that errors quote, and the errors found so far.
#pragma once

#include <tiny_gltf.h>

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/content/gltf_reader.hpp"
#include "engine/content/json_reader.hpp"

namespace fascicle::detail {

class GltfSource {
 public:
  explicit GltfSource(std::string file_name) : file(std::move(file_name)) {}

  // `path` is a JSON pointer into the glTF document. A .gltf gives the line and column, too.
  void error(std::string path, std::string cause, std::string remedy);
  void warning(std::string path, std::string cause, std::string remedy);
  bool ok() const { return diagnostics.ok(); }

  // Counts elements (vertices, indices, keys) against a limit for the whole file, so that a small hostile one cannot
  // ask for all memory. False, with an error at `path`, beyond it.
  bool spend(std::size_t elements, const std::string& path);

  std::string file;
  tinygltf::Model model;
  Diagnostics diagnostics;
  std::optional<JsonDocument> document;
  bool has_positions = false;  // .gltf: positions in the document are positions in the file

 private:
  Diagnostic make(std::string path, std::string cause, std::string remedy) const;
  std::size_t spent_ = 0;
};

// Makes names unique: a second "leg" becomes "leg_2".
class UniqueNames {
 public:
  // `name`, or `fallback` where it is empty, with a number where it is taken already.
  std::string take(const std::string& name, const std::string& fallback);

 private:
  std::map<std::string, int> uses_;  // by name: how many asked for it
};

// Fills document and model: splits a .glb, checks the JSON's shape, and lets tinygltf decode it with its buffers.
void load_gltf_model(GltfSource& source, std::span<const std::uint8_t> bytes, const std::filesystem::path& base_folder);

// Checks kinds, ranges and references of everything in the JSON that the reader uses.
void check_gltf_shape(GltfSource& source);

// Each fills its part of `out` from the model; later ones need the earlier.
void convert_nodes(GltfSource& source, GltfFile& out);
void convert_skins(GltfSource& source, GltfFile& out);
void convert_meshes(GltfSource& source, GltfFile& out);
void convert_animations(GltfSource& source, GltfFile& out);

}  // namespace fascicle::detail
