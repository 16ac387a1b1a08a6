#include "engine/geometry/mesh_pieces.hpp"

#include <limits>

#include "engine/geometry/mesh_edges.hpp"

namespace fascicle {

MeshPieces find_pieces(std::span<const std::uint32_t> indices, std::size_t vertex_count) {
  constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();
  const MeshEdges edges = find_edges(indices, vertex_count);
  const auto triangles = static_cast<std::uint32_t>(indices.size() / 3);
  MeshPieces pieces;
  pieces.piece.assign(triangles, kNone);
  std::vector<std::uint32_t> open;
  for (std::uint32_t first = 0; first < triangles; ++first) {
    if (pieces.piece[first] != kNone) continue;
    const auto number = static_cast<std::uint32_t>(pieces.count++);
    pieces.piece[first] = number;
    open.push_back(first);
    while (!open.empty()) {
      const std::uint32_t triangle = open.back();
      open.pop_back();
      for (std::uint32_t side = 3 * triangle; side < 3 * triangle + 3; ++side) {
        const std::uint32_t across = edges.opposite[side];
        if (across == kNoSide || pieces.piece[across / 3] != kNone) continue;
        pieces.piece[across / 3] = number;
        open.push_back(across / 3);
      }
    }
  }
  return pieces;
}

}  // namespace fascicle
