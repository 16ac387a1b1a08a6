// A bounding volume tree over a mesh's triangles, for the questions that this folder answers by itself: nearest points
// and winding numbers. (Rays go through Embree.) Splits at the median along the longest side, so its depth is
// log2(triangles) whatever the mesh is like, and equal meshes give equal trees.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <glm/vec3.hpp>

#include "engine/content/triangle_mesh.hpp"

namespace fascicle {

struct TriangleTree {
  // A node's left child is the next node. Leaves hold `count` triangles from `first`; else count is 0.
  struct Node {
    glm::vec3 lower, upper;
    std::uint32_t first = 0;  // triangle of a leaf; or the right child
    std::uint32_t count = 0;
  };

  std::vector<Node> nodes;                          // the root first; empty: no triangle
  std::vector<std::array<glm::vec3, 3>> triangles;  // corners, in the leaves' order
  std::vector<std::uint32_t> numbers;               // their numbers in the mesh
};

inline constexpr std::uint32_t kTreeLeafSize = 4;
inline constexpr std::size_t kTreeStackSize = 64;  // enough for 2^32 triangles

// Leaves out triangles with a corner that is not finite. Indices must be in range.
TriangleTree build_triangle_tree(const TriangleMesh& mesh);

}  // namespace fascicle
