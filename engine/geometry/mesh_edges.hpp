// Which triangles meet at which edge. A side is the directed edge of one triangle: side 3 t + k goes from the corner k
// of triangle t to the next.
#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

namespace fascicle {

constexpr std::uint32_t kNoSide = std::numeric_limits<std::uint32_t>::max();

inline std::uint32_t next_side(std::uint32_t side) { return side % 3 == 2 ? side - 2 : side + 1; }

struct MeshEdges {
  std::vector<std::uint32_t> sides;     // grouped by edge; in a group they rise
  std::vector<std::uint32_t> offsets;   // edge e has sides[offsets[e]] .. sides[offsets[e + 1] - 1]
  std::vector<std::uint32_t> opposite;  // for each side the other one of its edge; kNoSide unless the edge has two

  std::size_t count() const { return offsets.size() - 1; }
  std::span<const std::uint32_t> sides_of(std::size_t edge) const {
    return std::span(sides).subspan(offsets[edge], offsets[edge + 1] - offsets[edge]);
  }
};

// Edges in order of their lower, then their higher vertex. No triangle has a vertex twice.
MeshEdges find_edges(std::span<const std::uint32_t> indices, std::size_t vertex_count);

}  // namespace fascicle
