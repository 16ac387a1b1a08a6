#include "engine/render/strip_topology.hpp"

#include "engine/render/draw_types.hpp"

namespace fascicle {

void append_tube_vertices(std::uint32_t rows, std::uint32_t row_vertices, StripTopology& topology) {
  const auto first_vertex = static_cast<std::uint32_t>(topology.vertices.size());
  const std::uint32_t first_row = topology.row_count;
  const float last_row = rows > 1 ? static_cast<float>(rows - 1) : 1.0f;
  for (std::uint32_t row = 0; row < rows; ++row) {
    for (std::uint32_t i = 0; i < row_vertices; ++i) {
      topology.vertices.push_back({first_row + row, static_cast<float>(i) / static_cast<float>(row_vertices),
                                   static_cast<float>(row) / last_row});
      topology.ring_indices.push_back(first_vertex + row * row_vertices + i);
    }
    topology.ring_indices.push_back(first_vertex + row * row_vertices);
    topology.ring_indices.push_back(kPrimitiveRestart);
  }
  topology.vertices.push_back({first_row, StripVertexInfo::kAxis, 0.0f});
  topology.vertices.push_back({first_row + rows - 1, StripVertexInfo::kAxis, 1.0f});
  topology.row_count += rows;
  topology.item_count += 1;
}

void append_tube_indices(std::uint32_t first_vertex, std::uint32_t rows, std::uint32_t row_vertices,
                         StripTopology& topology) {
  for (std::uint32_t row = 0; row + 1 < rows; ++row) {
    const std::uint32_t here = first_vertex + row * row_vertices;
    for (std::uint32_t i = 0; i <= row_vertices; ++i) {
      const std::uint32_t column = i % row_vertices;
      topology.strip_indices.push_back(here + row_vertices + column);
      topology.strip_indices.push_back(here + column);
    }
    topology.strip_indices.push_back(kPrimitiveRestart);
  }
  const std::uint32_t first_centre = first_vertex + rows * row_vertices;
  const std::uint32_t last_row = first_vertex + (rows - 1) * row_vertices;
  // The first cap faces backwards along the tube, so its fan runs the other way round.
  topology.fan_indices.push_back(first_centre);
  for (std::uint32_t i = 0; i <= row_vertices; ++i) {
    topology.fan_indices.push_back(first_vertex + (row_vertices - i) % row_vertices);
  }
  topology.fan_indices.push_back(kPrimitiveRestart);
  topology.fan_indices.push_back(first_centre + 1);
  for (std::uint32_t i = 0; i <= row_vertices; ++i) topology.fan_indices.push_back(last_row + i % row_vertices);
  topology.fan_indices.push_back(kPrimitiveRestart);
}

}  // namespace fascicle
