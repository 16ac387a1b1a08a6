// Shapes of a mesh's cross sections, statistically (the method's 2.5): how round they are, whether they are convex, and
// whether their centroids lie inside. What a model of few vertices a section must be able to follow.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "engine/geometry/slice_mesh.hpp"

namespace fascicle {

struct SliceShape {
  double quotient = 0.0;              // isoperimetric: 4 pi area / perimeter^2, 1 for a circle
  double normalised_perimeter = 0.0;  // perimeter / sqrt(area): of the same shape with an area of 1
  double dent = 0.0;                  // the outline's deepest place below its convex hull / sqrt(area)
  bool convex = false;                // no dent deeper than 0.01: every triangulated surface has shallow ones
  bool centroid_inside = false;
};

// A loop without area has all zeros. The sense in which it turns does not matter.
SliceShape measure_shape(const SliceLoop& loop);

// The loop scaled to an area of 1, its centroid at the origin, its longer axis of inertia along x, anticlockwise. Empty
// for a loop without area.
std::vector<glm::dvec2> normalise_outline(const SliceLoop& loop);

struct SliceStation {
  double fraction = 0.0;  // of the line's length
  SlicePlane plane;       // square to the line
};

// Planes across a polyline at fractions of its length. At bends, which have no one direction, that between points a
// twentieth of the length before and after. Empty where the line has no length.
std::vector<SliceStation> place_stations(std::span<const glm::dvec3> line, std::span<const double> fractions);
// The same across the straight line along the mesh's principal axis, from end to end.
std::vector<SliceStation> place_stations(const TriangleMesh& mesh, std::span<const double> fractions);

struct SliceOutline {
  SliceLoop loop;
  SliceShape shape;
};

// One plane through one mesh. `loops` come by falling area (absolute): the first is the slice's outline.
struct MeshSlice {
  std::string mesh;
  double fraction = 0.0;
  std::vector<SliceOutline> loops;  // empty: the plane misses the mesh
};

std::vector<MeshSlice> slice_at(const TriangleMesh& mesh, std::span<const SliceStation> stations);

// Over the first loop of each slice that has one with an area.
struct SliceSummary {
  std::size_t slices = 0, missed = 0;
  double mean_quotient = 0.0, median_quotient = 0.0;
  double share_round = 0.0;             // with a quotient above 0.5
  double share_concave = 0.0;
  double share_centroid_outside = 0.0;
  double share_several = 0.0;           // that are cut in more than one loop
};

SliceSummary summarise_slices(std::span<const MeshSlice> slices);

}  // namespace fascicle
