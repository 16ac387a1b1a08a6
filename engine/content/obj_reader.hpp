// Wavefront .obj: vertices and polygons. An own reader, because the packaged ones (tinyobjloader, Assimp) tell no place
// of an error.
#pragma once

#include <filesystem>
#include <string>

#include "engine/content/result.hpp"
#include "engine/content/triangle_mesh.hpp"

namespace fascicle {

// All objects and groups joined. Polygons become triangle fans, vertices keep their order. Texture coordinates,
// normals (which a corner has here, not a vertex), materials, lines and points are left out; so are curved surfaces,
// with a warning.
Result<TriangleMesh> read_obj(const std::filesystem::path& file);
Result<TriangleMesh> parse_obj(std::string text, std::string file_name);

}  // namespace fascicle
