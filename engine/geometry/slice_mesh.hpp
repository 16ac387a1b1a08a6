// The curves in which a plane cuts a mesh (thesis appendix E: the slice's edges sorted into loops).
//
// A vertex exactly on the plane counts as just above it, always, as if the plane were an infinitesimal lower. So each
// triangle is cut in one segment or none, loops never touch themselves at vertices, and every loop of a closed mesh
// closes, whatever lies in the plane.
#pragma once

#include <cstdint>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "engine/content/triangle_mesh.hpp"

namespace fascicle {

// u and v are of unit length and square to each other; the plane's normal is u x v.
struct SlicePlane {
  glm::dvec3 origin{0.0};  // m
  glm::dvec3 u{1.0, 0.0, 0.0}, v{0.0, 1.0, 0.0};
};

// Any u and v square to `normal`, which need not be of unit length. A zero normal counts as z.
SlicePlane plane_across(const glm::dvec3& origin, const glm::dvec3& normal);

// Points are in the plane's coordinates (m): origin + x u + y v. Seen with the normal towards the eye the mesh's inside
// lies to the left, so an outline turns anticlockwise and the outline of a hole clockwise. Where the mesh's triangles
// disagree about its outside, the greater part of the loop's length decides.
struct SliceLoop {
  std::vector<glm::dvec2> points;        // the first is not repeated at the end
  std::vector<std::uint32_t> triangles;  // that the segment from each point cuts; an open chain has one fewer
  bool closed = true;                    // false: a chain that ends where the mesh does
  double area = 0.0;                     // m^2, signed: an outline's is positive. A chain counts as closed straight
  double perimeter = 0.0;                // m; of a chain without the closing line
  glm::dvec2 centroid{0.0};              // of the area; of the curve where the area is zero
};

// Every loop and chain, in the order of the lowest triangle that each cuts, but not those of no length. Triangles with
// a corner that is not finite are left out. Linear in the mesh's size, with a small factor: it may be called for each
// section of a fit.
std::vector<SliceLoop> slice_mesh(const TriangleMesh& mesh, const SlicePlane& plane);

// Area, perimeter and centroid from points and `closed`.
void measure_loop(SliceLoop& loop);

}  // namespace fascicle
