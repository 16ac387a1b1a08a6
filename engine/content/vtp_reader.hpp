// VTK PolyData in XML (.vtp), as bone meshes of OpenSim models are given and ParaView saves surfaces: arrays as text,
// in base64 or appended, also compressed with zlib.
#pragma once

#include <filesystem>
#include <string>

#include "engine/content/result.hpp"
#include "engine/content/triangle_mesh.hpp"

namespace fascicle {

// Polygons become triangle fans, strips become triangles, vertices keep their order; normals are kept where the file
// gives them for points. The mesh is named after the file. Errors: not XML, not PolyData, compressed otherwise than by
// zlib, counts that don't agree, indices out of range, numbers that aren't.
Result<TriangleMesh> read_vtp(const std::filesystem::path& file);
Result<TriangleMesh> parse_vtp(std::string text, std::string file_name);

}  // namespace fascicle
