// VTK legacy PolyData (.vtk), versions 1 to 5.1, ASCII and BINARY, as anatomical meshes of the visualisation toolkit's
// tools come: surfaces, and polylines for fibres. An own reader, because the toolkit's own is a hundred libraries whose
// reader trusts the counts in a file and tells no place.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include <glm/vec3.hpp>

#include "engine/content/result.hpp"
#include "engine/content/triangle_mesh.hpp"

namespace fascicle {

// Polygons become triangle fans, strips become triangles, vertices keep their order. Lines and single points are left
// out with a warning. What a file says about its points and cells (normals, scalars, fields, METADATA) is skipped.
// Errors name the line, in BINARY files the byte.
Result<TriangleMesh> read_vtk(const std::filesystem::path& file);
Result<TriangleMesh> parse_vtk(std::string bytes, std::string file_name);

struct PolylineSet {
  std::vector<glm::vec3> positions;   // in the file's unit
  std::vector<std::uint32_t> points;  // the lines' positions, one line after the other
  std::vector<std::uint32_t> ends;    // line l is points[ends[l - 1]] .. points[ends[l] - 1]; the first begins at 0

  std::span<const std::uint32_t> line(std::size_t l) const {
    const std::size_t begin = l == 0 ? 0 : ends[l - 1];
    return std::span(points).subspan(begin, ends[l] - begin);
  }
};

// The LINES of such a file. Polygons are left out with a warning. Error: there are none.
Result<PolylineSet> read_polylines(const std::filesystem::path& file);
Result<PolylineSet> parse_polylines(std::string bytes, std::string file_name);

}  // namespace fascicle
