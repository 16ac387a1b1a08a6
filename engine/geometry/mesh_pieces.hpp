// The pieces of a mesh: what hangs together by edges that two triangles share.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace fascicle {

struct MeshPieces {
  std::vector<std::uint32_t> piece;  // of each triangle; pieces are numbered by their first triangles
  std::size_t count = 0;
};

// No triangle has a vertex twice. Linear in the number of triangles, but for sorting.
MeshPieces find_pieces(std::span<const std::uint32_t> indices, std::size_t vertex_count);

}  // namespace fascicle
