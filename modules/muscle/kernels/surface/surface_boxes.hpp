// Where a surface muscle is at the start of a step, for the search for contacts: a box about each node of its tree and,
// for contacts with itself, between which bounds the normals in it lie. Two nodes whose bounds leave no two normals
// that point against each other can't touch, and neither can anything below them: along a surface that is not folded nearly
// all is passed over high up in the tree.
#pragma once

#include <cstdint>
#include <span>

#include "engine/math/aligned_vector.hpp"
#include "modules/muscle/asset/surface/surface_tree.hpp"

namespace fascicle::muscle {

struct alignas(16) SurfaceNormal {
  float x = 0.0f, y = 0.0f, z = 0.0f, unused = 0.0f;  // unit, outward; 0: no area
};

struct SurfaceBoxes {
  bool placed = false;                         // in this step; begin_step clears it
  AlignedVector<SurfaceRange> boxes;           // m, by node
  AlignedVector<SurfaceRange> normal_ranges;   // by node; empty where the muscle does not collide with itself
  AlignedVector<SurfaceNormal> triangle_normals;
  // The same in the order of the tree's triangles, and how high their planes are (m): four side by side.
  AlignedVector<float> plane_x, plane_y, plane_z, plane_height;
  AlignedVector<SurfacePoint> own_points;      // by place in the tree's vertices; of leaves' own alone
  AlignedVector<SurfaceRange> vertex_normals;  // by vertex: of its triangles, so a sharp corner faces many ways
};

inline constexpr std::size_t kPlaneLanes = 4;  // planes beyond the last triangle's, for loads that reach over it

// Makes room. `itself`: for contacts with itself, too.
void lay_out_boxes(const SurfaceTree& tree, const SurfaceAsset& asset, bool itself, SurfaceBoxes& boxes);

// Boxes of `points` and, where there is room for them, normals. Once a step, before find_pairs.
void place_boxes(const SurfaceTree& tree, const SurfaceAsset& asset, std::span<const SurfacePoint> points,
                 SurfaceBoxes& boxes);

}  // namespace fascicle::muscle
