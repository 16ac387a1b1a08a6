// What the search for a surface muscle's contacts needs to know and never changes while it deforms: its triangles in
// the leaves of a tree of boxes, and how it lay at rest. Immutable, shared by all characters that have the muscle.
//
// The mesh keeps its neighbours however it bends, so the tree stays good and only its boxes are taken anew each step
// (kernels/surface/surface_boxes.hpp): no grid to fill, no cell size to choose. Leaves are cut by place *and* normal,
// so the two sides of a thin muscle lie in different leaves, and whole branches that nowhere face each other can be passed
// over.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "engine/math/aligned_vector.hpp"
#include "modules/muscle/asset/surface/surface_asset.hpp"

namespace fascicle::muscle {

// A box, or between which bounds normals lie.
struct alignas(32) SurfaceRange {
  std::array<float, 4> lower{}, upper{};  // x, y, z and 0
};

struct SurfaceTree {
  // A node's left child is the next node. Leaves have `count` triangles from `first`; else count is 0.
  struct Node {
    std::uint32_t first = 0, count = 0;       // in `triangles`
    std::uint32_t right = 0;                  // child; of a leaf 0
    std::uint32_t first_vertex = 0;           // in `vertices`
    std::uint32_t own = 0, vertex_count = 0;  // the leaf's own vertices come first, then those of its neighbours
  };

  std::vector<Node> nodes;               // the root first; empty: no triangle
  std::vector<std::uint32_t> triangles;  // numbers in the mesh, in the leaves' order
  std::vector<std::uint32_t> vertices;   // by leaf; each vertex is one leaf's own
  AlignedVector<SurfaceRange> rest_normals;  // by vertex: of the unit normals of its triangles
};

inline constexpr std::uint32_t kSurfaceLeaf = 8;  // triangles at most

// The answer depends on the rest shape and the triangles alone. Of an asset as build_surface_asset makes them.
SurfaceTree build_surface_tree(const SurfaceAsset& asset);

}  // namespace fascicle::muscle
