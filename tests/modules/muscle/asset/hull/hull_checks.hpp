// Whether a hull is one: closed, manifold, and round everything of the mesh that it was made from. None of it asks the
// code under test.
#pragma once

#include <algorithm>
#include <array>
#include <set>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "engine/content/triangle_mesh.hpp"
#include "engine/geometry/closest_point.hpp"
#include "engine/geometry/mesh_edges.hpp"
#include "engine/geometry/mesh_measures.hpp"
#include "engine/geometry/winding_number.hpp"

namespace fascicle::test {

// What is wrong with the mesh as a closed manifold; empty where nothing is. All vertices are used.
inline std::string manifold_fault(const TriangleMesh& mesh) {
  std::vector<std::size_t> fan(mesh.positions.size(), 0);
  std::set<std::array<std::uint32_t, 3>> seen;
  for (std::size_t t = 0; t < mesh.indices.size(); t += 3) {
    std::array<std::uint32_t, 3> corners{mesh.indices[t], mesh.indices[t + 1], mesh.indices[t + 2]};
    for (const std::uint32_t corner : corners) ++fan.at(corner);
    std::ranges::sort(corners);
    if (corners[0] == corners[1] || corners[1] == corners[2]) return fmt::format("triangle {} is a line", t / 3);
    if (!seen.insert(corners).second) return fmt::format("triangle {} is there twice", t / 3);
  }
  const MeshEdges edges = find_edges(mesh.indices, mesh.positions.size());
  for (std::size_t e = 0; e < edges.count(); ++e) {
    const auto sides = edges.sides_of(e);
    if (sides.size() != 2) return fmt::format("an edge has {} triangles", sides.size());
    if (mesh.indices[sides[0]] == mesh.indices[sides[1]]) return "an edge runs the same way twice";
  }
  // Walking round a vertex from triangle to triangle meets all of its triangles.
  std::vector<std::uint32_t> first(mesh.positions.size(), kNoSide);
  for (std::uint32_t side = 0; side < mesh.indices.size(); ++side) first[mesh.indices[side]] = side;
  for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
    if (first[v] == kNoSide) return fmt::format("vertex {} is not used", v);
    std::size_t met = 0;
    std::uint32_t side = first[v];
    do {
      ++met;
      side = next_side(edges.opposite[side]);
    } while (side != first[v] && met <= fan[v]);
    if (met != fan[v]) return fmt::format("{} of {} triangles hang together at vertex {}", met, fan[v], v);
  }
  return {};
}

// How far the outermost vertex of `fine` is outside of `hull`, relative to the size of `fine`.
inline double outside(const TriangleMesh& fine, const TriangleMesh& hull) {
  const ClosestPoints surface(hull);
  const WindingField windings(hull);
  double furthest = 0.0;
  for (const glm::vec3& position : fine.positions) {
    const double distance = surface.at(position).distance;
    if (distance > furthest && !windings.inside(glm::dvec3(position))) furthest = distance;
  }
  return furthest / static_cast<double>(mesh_bounds(fine).diagonal());
}

// The least shape of a triangle: 1 where all are equilateral, 0 where one has no area.
inline double least_shape(const TriangleMesh& mesh) {
  double least = 1.0;
  for (std::size_t t = 0; t < mesh.indices.size(); t += 3) {
    const glm::dvec3 a(mesh.positions[mesh.indices[t]]), b(mesh.positions[mesh.indices[t + 1]]),
        c(mesh.positions[mesh.indices[t + 2]]);
    const double sides = glm::dot(b - a, b - a) + glm::dot(c - b, c - b) + glm::dot(a - c, a - c);
    least = std::min(least, 2.0 * std::sqrt(3.0) * glm::length(glm::cross(b - a, c - a)) / sides);
  }
  return least;
}

}  // namespace fascicle::test
