// The part of a mesh's slice that one section belongs to, where the section's plane cuts the mesh in several loops: two
// heads, a part that bends back, an island of another part. Rays that know nothing of loops would run from one to the
// other; here they stay in one.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include <glm/vec2.hpp>

#include "engine/content/triangle_mesh.hpp"
#include "engine/geometry/slice_mesh.hpp"
#include "modules/muscle/asset/fit/fit_surface.hpp"
#include "modules/muscle/asset/fit/rest_frames.hpp"

namespace fascicle::muscle {

// An outline, or outlines of shells that overlap, and the outlines of the holes in them; in the section's u and v from
// its centre, m. What the loops wind round at least once is inside.
struct SectionSlice {
  std::vector<SliceLoop> loops;
  double area = 0.0;         // m^2; where shells overlap it counts twice
  glm::dvec2 centroid{0.0};  // of the greatest outline

  bool contains(const glm::dvec2& point) const;
  double distance(const glm::dvec2& point) const;  // m, to the nearest loop
};

// The slices of a section by falling area; open chains are left out.
std::vector<SectionSlice> slice_section(const TriangleMesh& mesh, const SectionFrame& frame);

// The stretches of the line from the section's centre along the unit `direction` inside the slice, by rising t.
void find_inside(const SectionSlice& slice, const glm::dvec2& direction, std::vector<InsideInterval>& intervals);

// A point deep inside: as far from all loops as a grid of a few hundred points and its refinement find.
glm::dvec2 deepest_point(const SectionSlice& slice);

// Of rays' ends: one loop.
SectionSlice slice_of(std::vector<glm::dvec2> points);

// Which slice of each section continues best along the line: the chain with the least sum of squared distances between
// the neighbours' centroids, squared differences of their sizes (roots of area), and squared distances from each
// section's centre to its slice. By section; candidates[k] may be empty: then chosen[k] is -1 and the chain passes
// over it.
std::vector<int> choose_slices(std::span<const SectionFrame> frames,
                               std::span<const std::vector<SectionSlice>> candidates);

}  // namespace fascicle::muscle
