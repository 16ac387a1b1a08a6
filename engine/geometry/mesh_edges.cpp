#include "engine/geometry/mesh_edges.hpp"

#include <algorithm>
#include <tuple>

namespace fascicle {

MeshEdges find_edges(std::span<const std::uint32_t> indices, std::size_t vertex_count) {
  struct Entry {
    std::uint32_t high, side;
  };
  const auto side_count = static_cast<std::uint32_t>(indices.size());
  const auto low_of = [&](std::uint32_t side) { return std::min(indices[side], indices[next_side(side)]); };

  // A counting sort by the lower vertex, then small sorts by the higher.
  std::vector<std::uint32_t> ends(vertex_count + 1, 0);
  for (std::uint32_t side = 0; side < side_count; ++side) ++ends[low_of(side) + 1];
  for (std::size_t v = 0; v < vertex_count; ++v) ends[v + 1] += ends[v];
  std::vector<Entry> entries(side_count);
  for (std::uint32_t side = 0; side < side_count; ++side)
    entries[ends[low_of(side)]++] = {std::max(indices[side], indices[next_side(side)]), side};
  MeshEdges edges;
  edges.sides.reserve(side_count);
  edges.opposite.assign(side_count, kNoSide);
  std::uint32_t begin = 0;
  for (std::size_t v = 0; v < vertex_count; begin = ends[v], ++v) {
    std::sort(entries.begin() + begin, entries.begin() + ends[v],
              [](const Entry& a, const Entry& b) { return std::tie(a.high, a.side) < std::tie(b.high, b.side); });
    for (std::uint32_t i = begin; i < ends[v]; ++i) {
      if (i == begin || entries[i].high != entries[i - 1].high) edges.offsets.push_back(i);
      edges.sides.push_back(entries[i].side);
    }
  }
  edges.offsets.push_back(side_count);
  for (std::size_t e = 0; e < edges.count(); ++e) {
    const std::span<const std::uint32_t> sides = edges.sides_of(e);
    if (sides.size() != 2) continue;
    edges.opposite[sides[0]] = sides[1];
    edges.opposite[sides[1]] = sides[0];
  }
  return edges;
}

}  // namespace fascicle
