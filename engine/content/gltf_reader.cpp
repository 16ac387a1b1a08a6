#include "engine/content/gltf_reader.hpp"

#include <algorithm>

#include "engine/content/file_text.hpp"
#include "engine/content/gltf_source.hpp"

namespace fascicle {

const GltfMesh* GltfFile::find_mesh(std::string_view name) const {
  auto found = std::ranges::find(meshes, name, &GltfMesh::name);
  if (found == meshes.end()) found = std::ranges::find(meshes, name, &GltfMesh::mesh_name);
  return found == meshes.end() ? nullptr : &*found;
}

const Clip* GltfFile::find_clip(std::string_view name) const {
  const auto found = std::ranges::find(clips, name, &Clip::name);
  return found == clips.end() ? nullptr : &*found;
}

Result<GltfFile> parse_gltf(std::span<const std::uint8_t> bytes, const std::filesystem::path& base_folder,
                            std::string file_name) {
  detail::GltfSource source(std::move(file_name));
  GltfFile out;
  out.file = source.file;
  detail::load_gltf_model(source, bytes, base_folder);
  // Each step relies on what the one before has checked.
  for (const auto step :
       {detail::convert_nodes, detail::convert_skins, detail::convert_meshes, detail::convert_animations}) {
    if (source.ok()) step(source, out);
  }
  if (!source.ok()) return std::move(source.diagnostics);
  return {std::move(out), std::move(source.diagnostics)};
}

Result<GltfFile> read_gltf(const std::filesystem::path& file) {
  const Result<std::string> bytes = read_text_file(file);
  if (!bytes) return bytes.diagnostics();
  const std::filesystem::path folder = file.has_parent_path() ? file.parent_path() : std::filesystem::path(".");
  return parse_gltf({reinterpret_cast<const std::uint8_t*>(bytes->data()), bytes->size()}, folder, file.string());
}

}  // namespace fascicle
