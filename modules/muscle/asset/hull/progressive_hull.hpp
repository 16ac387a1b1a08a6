// A progressive hull (Sander et al. 2000): a coarse closed mesh that encloses a fine one. Edges are collapsed, the
// cheapest first, each to the point that adds the least volume among those on or outside of the planes of all
// triangles around the edge: a linear program in three variables. So every mesh on the way encloses the one before.
#pragma once

#include <cstdint>

#include "engine/content/result.hpp"
#include "engine/content/triangle_mesh.hpp"

namespace fascicle::muscle {

inline constexpr std::uint32_t kFewestHullVertices = 4;

struct HullTarget {
  std::uint32_t vertices = 300;  // stop at so many
  float error = 0.0f;            // m: stop before a hull vertex is further than this from the mesh; 0: no such limit
};

struct ProgressiveHull {
  TriangleMesh mesh;             // m; closed, manifold, in the fine mesh's orientation
  double volume = 0.0;           // m^3
  double fine_volume = 0.0;      // m^3
  float distance = 0.0f;         // m: of the hull vertex that is furthest from the fine mesh
  double overhead() const { return volume / fine_volume - 1.0; }
};

// `mesh`: closed, manifold, one piece, positive volume (check_surface.hpp makes sure). The result may have more vertices
// than asked where no further edge can be collapsed: warned of, with the number; an error is only a mesh that is none.
// The same mesh gives the same hull, bit for bit. No fine vertex is outside by more than 1e-6 of the mesh's size.
Result<ProgressiveHull> build_progressive_hull(const TriangleMesh& mesh, const HullTarget& target);

}  // namespace fascicle::muscle
