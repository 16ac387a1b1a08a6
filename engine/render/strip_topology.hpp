// The constant part of a strip surface: which vertices make which strips, fans and rings, and where on the surface a
// vertex lies. Uploaded once and shared by all instances (characters) that have it.
#pragma once

#include <cstdint>
#include <vector>

namespace fascicle {

// Where a vertex lies on its surface.
struct StripVertexInfo {
  std::uint32_t row = 0;  // index into the instance's rows
  float turn = 0.0f;      // fraction of a turn around its row, 0..1; kAxis for a cap centre
  float along = 0.0f;     // fraction of the item's length, 0 at the first row, 1 at the last

  static constexpr float kAxis = -1.0f;
};

// All indices are relative to the instance's first vertex; kPrimitiveRestart separates primitives.
struct StripTopology {
  std::vector<StripVertexInfo> vertices;     // one a vertex
  std::vector<std::uint32_t> strip_indices;  // triangle strips
  std::vector<std::uint32_t> fan_indices;    // triangle fans
  std::vector<std::uint32_t> ring_indices;   // line strips: the rows' outlines, drawn on request; may be empty
  std::uint32_t row_count = 0;
  std::uint32_t item_count = 0;
};

// Appends one item's vertex infos and rings: `rows` rows of `row_vertices` vertices, then its two cap centres (first
// row's, last row's), the order in which the vertices are written each step. Raises row_count and item_count.
// Strip and fan indices are the caller's, or `append_tube_indices`'.
void append_tube_vertices(std::uint32_t rows, std::uint32_t row_vertices, StripTopology& topology);

// Appends the strips (one a segment, 2 (row_vertices + 1) indices) and the two cap fans (row_vertices + 2 indices)
// of a tube whose first vertex is `first_vertex`. Triangles are anticlockwise seen from outside where the rows'
// vertices turn anticlockwise about the direction from first to last row.
void append_tube_indices(std::uint32_t first_vertex, std::uint32_t rows, std::uint32_t row_vertices,
                         StripTopology& topology);

}  // namespace fascicle
