// Stanford polygon files (.ply): ASCII, binary little and big endian. An own reader, because the packaged one (Assimp)
// tells no place of an error.
#pragma once

#include <filesystem>
#include <string>

#include "engine/content/result.hpp"
#include "engine/content/triangle_mesh.hpp"

namespace fascicle {

// `vertex` with x, y, z, `face` with vertex_indices (or vertex_index) and `tristrips`; other elements and properties
// are skipped. Polygons become triangle fans, vertices keep their order. Errors name the line, in binary files the
// byte.
Result<TriangleMesh> read_ply(const std::filesystem::path& file);
Result<TriangleMesh> parse_ply(std::string bytes, std::string file_name);

}  // namespace fascicle
