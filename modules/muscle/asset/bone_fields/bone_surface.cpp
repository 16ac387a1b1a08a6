#include "modules/muscle/asset/bone_fields/bone_surface.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <tuple>
#include <vector>

#include <glm/geometric.hpp>

#include "engine/geometry/clean_mesh.hpp"
#include "engine/geometry/winding_number.hpp"
#include "engine/parallel/for_range.hpp"

namespace fascicle::muscle {

namespace {

// An edge that more triangles pass from `from` to `to` than back.
struct OpenEdge {
  std::uint32_t from, to;
};

std::vector<OpenEdge> find_open_edges(const std::vector<std::uint32_t>& indices) {
  struct Side {
    std::uint32_t low, high;
    bool rises;
  };
  std::vector<Side> sides;
  sides.reserve(indices.size());
  for (std::size_t i = 0; i < indices.size(); ++i) {
    const std::uint32_t from = indices[i], to = indices[i % 3 == 2 ? i - 2 : i + 1];
    sides.push_back({std::min(from, to), std::max(from, to), from < to});
  }
  std::sort(sides.begin(), sides.end(),
            [](const Side& a, const Side& b) { return std::tie(a.low, a.high) < std::tie(b.low, b.high); });
  std::vector<OpenEdge> open;
  for (std::size_t first = 0, last = 0; first < sides.size(); first = last) {
    int balance = 0;
    const Side& edge = sides[first];
    for (; last < sides.size() && sides[last].low == edge.low && sides[last].high == edge.high; ++last) {
      balance += sides[last].rises ? 1 : -1;
    }
    for (; balance > 0; --balance) open.push_back({edge.low, edge.high});
    for (; balance < 0; ++balance) open.push_back({edge.high, edge.low});
  }
  return open;
}

// Open edges together come and go equally often at every vertex, so triangles from each to any one point close them,
// whatever they look like. The point is the middle of those that hang together: of a hole's rim.
void cap_holes(TriangleMesh& mesh) {
  const std::vector<OpenEdge> open = find_open_edges(mesh.indices);
  if (open.empty()) return;
  std::vector<std::uint32_t> root(mesh.positions.size());
  std::iota(root.begin(), root.end(), 0u);
  const auto find = [&](std::uint32_t vertex) {
    while (root[vertex] != vertex) vertex = root[vertex] = root[root[vertex]];
    return vertex;
  };
  for (const OpenEdge& edge : open) {
    const std::uint32_t a = find(edge.from), b = find(edge.to);
    root[std::max(a, b)] = std::min(a, b);
  }
  std::vector<glm::dvec3> sums(mesh.positions.size(), glm::dvec3(0.0));
  std::vector<std::uint32_t> counts(mesh.positions.size(), 0);
  for (const OpenEdge& edge : open) {
    sums[find(edge.from)] += glm::dvec3(mesh.positions[edge.from]);
    ++counts[find(edge.from)];
  }
  std::vector<std::uint32_t> middles(sums.size(), 0);
  for (std::size_t i = 0; i < sums.size(); ++i) {
    if (counts[i] == 0) continue;
    middles[i] = static_cast<std::uint32_t>(mesh.positions.size());
    mesh.positions.emplace_back(sums[i] / static_cast<double>(counts[i]));
  }
  for (const OpenEdge& edge : open) {
    for (const std::uint32_t index : {edge.to, edge.from, middles[find(edge.from)]}) mesh.indices.push_back(index);
  }
}

using Corners = std::array<glm::dvec3, 3>;

// Sorts triangles into those with the outside beside them and those without.
class Uncover {
 public:
  Uncover(const WindingField& winding, double voxel) : winding_(winding), voxel_(voxel) {}

  // Appends what is not buried of a triangle, cut where it is so in part.
  void run(const Corners& corners, std::vector<Corners>& kept, int cuts = kMostCuts) const {
    const glm::dvec3 middle = (corners[0] + corners[1] + corners[2]) / 3.0;
    const glm::dvec3 area = glm::cross(corners[1] - corners[0], corners[2] - corners[0]);
    const double size = glm::length(area);
    if (!(size > 0.0)) return kept.push_back(corners);
    const glm::dvec3 step = area * (0.05 * voxel_ / size);
    const double longest = std::max({glm::distance(corners[0], corners[1]), glm::distance(corners[1], corners[2]),
                                     glm::distance(corners[2], corners[0])});
    const bool small = longest < 3.0 * voxel_ || cuts == 0;
    int buried = 0;
    for (const glm::dvec3& towards : {middle, corners[0], corners[1], corners[2]}) {
      if (is_buried(0.9 * towards + 0.1 * middle, step)) ++buried;
      else if (small) return kept.push_back(corners);  // whatever the others say
    }
    if (buried == 4) return;
    if (buried == 0) return kept.push_back(corners);
    const glm::dvec3 ab = 0.5 * (corners[0] + corners[1]), bc = 0.5 * (corners[1] + corners[2]),
                     ca = 0.5 * (corners[2] + corners[0]);
    run({corners[0], ab, ca}, kept, cuts - 1);
    run({ab, corners[1], bc}, kept, cuts - 1);
    run({ca, bc, corners[2]}, kept, cuts - 1);
    run({ab, bc, ca}, kept, cuts - 1);
  }

 private:
  static constexpr int kMostCuts = 5;  // whatever the voxel

  bool is_buried(const glm::dvec3& point, const glm::dvec3& step) const {
    return winding_.inside(point + step) && winding_.inside(point - step);
  }

  const WindingField& winding_;
  double voxel_;
};

TriangleMesh uncover(const TriangleMesh& mesh, float voxel) {
  const WindingField winding(mesh);
  const Uncover each(winding, double{voxel});
  const std::size_t count = mesh.indices.size() / 3;
  constexpr std::size_t kGrain = 64;
  std::vector<std::vector<Corners>> kept(parallel::chunk_count(count, kGrain));
  parallel::for_range(count, kGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t t = begin; t < end; ++t) {
      each.run({mesh.positions[mesh.indices[3 * t]], mesh.positions[mesh.indices[3 * t + 1]],
                mesh.positions[mesh.indices[3 * t + 2]]}, kept[begin / kGrain]);
    }
  });
  TriangleMesh outer;
  for (const std::vector<Corners>& chunk : kept) {
    for (const Corners& corners : chunk) {
      for (const glm::dvec3& corner : corners) {
        outer.indices.push_back(static_cast<std::uint32_t>(outer.positions.size()));
        outer.positions.emplace_back(corner);
      }
    }
  }
  return outer;
}

}  // namespace

BoneSurface make_bone_surface(std::span<const TriangleMesh> meshes, float voxel) {
  BoneSurface surface;
  std::size_t parts = 0, crossings = 0;
  for (const TriangleMesh& mesh : meshes) {
    const CleanMesh clean = clean_mesh(mesh);
    parts += clean.defects.components;
    crossings += clean.defects.self_intersections;
    const auto first = static_cast<std::uint32_t>(surface.closed.positions.size());
    surface.closed.positions.insert(surface.closed.positions.end(), clean.mesh.positions.begin(),
                                    clean.mesh.positions.end());
    for (const std::uint32_t index : clean.mesh.indices) surface.closed.indices.push_back(first + index);
  }
  cap_holes(surface.closed);
  // A single shell that does not cross itself has nothing inside itself.
  if (parts > 1 || crossings > 0) surface.outer = uncover(surface.closed, voxel);
  if (surface.outer.indices.empty()) surface.outer = surface.closed;
  return surface;
}

}  // namespace fascicle::muscle
