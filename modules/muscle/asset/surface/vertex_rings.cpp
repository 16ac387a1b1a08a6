#include "modules/muscle/asset/surface/vertex_rings.hpp"

#include <algorithm>

namespace fascicle::muscle {
namespace {

struct Side {  // opposite of a triangle's corner
  std::int32_t from = 0, to = 0;
};

// Orders a vertex' sides so that each begins where the one before ended, as far as they do, and writes the way along
// them.
void walk(std::span<Side> sides, std::vector<std::int32_t>& way) {
  way.clear();
  for (std::size_t i = 0; i < sides.size(); ++i) {
    if (way.empty() || way.back() != sides[i].from) {
      if (!way.empty()) way.push_back(0);
      way.push_back(sides[i].from);
    }
    way.push_back(sides[i].to);
    const auto rest = sides.subspan(i + 1);
    const auto next = std::ranges::find(rest, sides[i].to, &Side::from);
    if (next != rest.end()) std::swap(rest.front(), *next);
  }
  if (way.empty()) way.push_back(0);
}

}  // namespace

VertexRings build_vertex_rings(std::span<const std::uint32_t> triangles, std::uint32_t vertex_count) {
  std::vector<std::uint32_t> end(vertex_count + 1, 0);  // of a vertex' sides
  for (const std::uint32_t v : triangles) ++end[v + 1];
  for (std::uint32_t v = 0; v < vertex_count; ++v) end[v + 1] += end[v];
  std::vector<std::uint32_t> filled(end.begin(), end.end() - 1);
  std::vector<Side> sides(triangles.size());
  for (std::size_t t = 0; t + 2 < triangles.size(); t += 3) {
    for (std::size_t corner = 0; corner < 3; ++corner) {
      sides[filled[triangles[t + corner]]++] = {static_cast<std::int32_t>(triangles[t + (corner + 1) % 3]),
                                                static_cast<std::int32_t>(triangles[t + (corner + 2) % 3])};
    }
  }

  VertexRings rings;
  rings.first.push_back(0);
  std::array<std::vector<std::int32_t>, 4> ways;
  for (std::uint32_t four = 0; four < vertex_count; four += 4) {
    std::size_t longest = 1;
    for (std::uint32_t lane = 0; lane < 4; ++lane) {
      const std::uint32_t v = four + lane;
      walk(v < vertex_count ? std::span(sides).subspan(end[v], end[v + 1] - end[v]) : std::span<Side>{}, ways[lane]);
      longest = std::max(longest, ways[lane].size());
    }
    for (std::size_t i = 0; i < longest; ++i) {
      std::array<std::int32_t, 4> row{};
      for (std::size_t lane = 0; lane < 4; ++lane) row[lane] = ways[lane][std::min(i, ways[lane].size() - 1)];
      rings.rows.push_back(row);
    }
    rings.first.push_back(static_cast<std::uint32_t>(rings.rows.size()));
  }
  return rings;
}

}  // namespace fascicle::muscle
