// A progressive hull (Sander et al. 2000): a coarse closed mesh that encloses a fine one. Edges are collapsed, the
// cheapest first, each to the point that adds the least volume among those on or outside of the planes of all
// triangles around the edge: a linear program in three variables. So every mesh on the way encloses the one before.
#pragma once

#include <cstdint>

#include "engine/content/result.hpp"
#include "engine/content/triangle_mesh.hpp"

namespace fascicle::muscle {

inline constexpr std::uint32_t kFewestHullVertices = 4;
// Grows whenever the same mesh would give another hull: stored ones are then out of date.
inline constexpr std::uint32_t kHullVersion = 1;

struct HullTarget {
  std::uint32_t vertices = 300;  // stop at so many
  float error = 0.0f;            // m: no collapse whose new vertex, or the middle of a new edge or triangle, would
                                 // be further than this from the mesh; 0: any.
};

struct ProgressiveHull {
  TriangleMesh mesh;             // m; closed, manifold, in the fine mesh's orientation
  double volume = 0.0;           // m^3
  double fine_volume = 0.0;      // m^3
  float distance = 0.0f;         // m: of the hull vertex that is furthest from the fine mesh
  double overhead() const { return volume / fine_volume - 1.0; }
};

// `mesh`: closed, every edge with two triangles that run along it in opposite directions, positive volume
// (check_surface.hpp makes sure); all else is an error, and so is a negative distance. A mesh that has no more vertices
// than asked for is its own hull. The hull may have more vertices than asked for, where nothing else collapses without
// folding the hull or going further away than allowed: that is warned of, with the number.
// The same mesh gives the same hull, bit for bit. It winds at least once round every point that the mesh winds round;
// no fine vertex is outside by more than 1e-6 of the mesh's size (or the rounding of positions, if that is more). Where
// the mesh passes close to itself the hull may pass through itself: triangles are only compared with those around.
Result<ProgressiveHull> build_progressive_hull(const TriangleMesh& mesh, const HullTarget& target);

}  // namespace fascicle::muscle
