// Does anything cross a section's surface? (3.2, thesis 4.1.2) Short rays run along the surface's own edges: round the
// section, c_i -> c_{i+1} (latitudinal), and to its neighbour, c_i^k -> c_{i+1}^{k+1}, or from the last section back,
// c_i^k -> c_{i+1}^{k-1} (diagonal). What one of them hits within its edge's length is in the muscle there. What lies
// between two edges, or has swallowed the whole section, they do not see.
//
// Both sides of a triangle count (Moller and Trumbore 1997), and edges that just touch one. A partner is its triangles
// as they are now; a bone has a tree over its own, built once in its frame, and the edges come to it.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

namespace fascicle {
struct TriangleTree;
}

namespace fascicle::muscle {

// From a vertex of the section, in any space.
struct SweepEdge {
  glm::vec3 from{0.0f}, to{0.0f};  // m
};
using SweepTriangle = std::array<glm::vec3, 3>;

// The rays of one section: `section` and `neighbour` are the |C| vertices of section k and of k + 1, or of k - 1 where
// k is the last. Edge i of each starts at vertex i. All spans of one length.
void sweep_edges(std::span<const glm::vec3> section, std::span<const glm::vec3> neighbour,
                 std::span<SweepEdge> latitudinal, std::span<SweepEdge> diagonal);

// The surface between two sections of |C| vertices, split along the drawn diagonals: 2 |C| triangles.
void segment_triangles(std::span<const glm::vec3> section, std::span<const glm::vec3> next,
                       std::span<SweepTriangle> triangles);

bool crosses(const SweepEdge& edge, const SweepTriangle& triangle);

// Sets hits[i] to 1 where edge i crosses a triangle, and leaves it where not, so that several partners add up.
void mark_crossings(std::span<const SweepEdge> edges, std::span<const SweepTriangle> triangles,
                    std::span<std::uint8_t> hits);

// The same against a tree in a frame of its own, `to_tree` from the edges' space.
void mark_crossings(std::span<const SweepEdge> edges, const TriangleTree& tree, const glm::mat4& to_tree,
                    std::span<std::uint8_t> hits);

// What the sweeps say of each vertex: `surrounded[i]` is 1 where one of its two latitudinal edges was hit. (Diagonal
// hits are by the vertex that they start from already.)
void mark_vertices(std::span<const std::uint8_t> latitudinal_hits, std::span<std::uint8_t> surrounded);

}  // namespace fascicle::muscle
