// Stereolithography files (.stl), binary and ASCII. An own reader, because the packaged ones (Assimp, ADMesh) tell no
// place of an error.
#pragma once

#include <filesystem>
#include <string>

#include "engine/content/result.hpp"
#include "engine/content/triangle_mesh.hpp"

namespace fascicle {

// Three vertices a triangle, in the file's order: the format has no shared ones, clean_mesh welds them. Normals of
// facets are left out. A file whose size is what the count at byte 80 makes is binary, whatever it begins with.
Result<TriangleMesh> read_stl(const std::filesystem::path& file);
Result<TriangleMesh> parse_stl(std::string bytes, std::string file_name);

}  // namespace fascicle
