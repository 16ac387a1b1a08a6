// One door to all mesh formats: the extension chooses the reader.
#pragma once

#include <filesystem>
#include <string>

#include "engine/content/result.hpp"
#include "engine/content/triangle_mesh.hpp"

namespace fascicle {

// "FILE" with the extension .vtk, .vtp, .obj, .ply or .stl, in the file's own frame and unit; or "FILE.glb#NAME",
// "FILE.gltf#NAME", where NAME is that of a mesh or of the node that carries it; without #NAME all meshes of the file
// are joined. glTF meshes come in the file's rest space (node transforms applied). Meshes come as the file has them,
// not welded and not checked: see geometry/clean_mesh.hpp.
Result<TriangleMesh> read_mesh(const std::string& file);

// Whether read_mesh knows the file's extension.
bool is_mesh_file(const std::filesystem::path& file);

// The same from a glTF file that was read already: one mesh by name, or with an empty name all of them joined.
struct GltfFile;
Result<TriangleMesh> extract_mesh(const GltfFile& file, const std::string& name);

// Splits "FILE#NAME"; the name is empty where there is none. Only a # after the extension counts.
struct MeshReference {
  std::filesystem::path file;
  std::string name;
};
MeshReference split_mesh_reference(const std::string& reference);

}  // namespace fascicle
