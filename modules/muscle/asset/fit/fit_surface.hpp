// The anatomical mesh as a fit sees it: what is inside along a line, also where the mesh has defects.
//
// Of a sound mesh the crossings of a line say all: it enters and leaves in turn. Where the mesh has holes, or parts
// that are inside out, they do not; then the winding number decides, and inside is where it exceeds one half, so that a
// line may enter or leave through a hole, where no triangle is.
#pragma once

#include <atomic>
#include <memory>
#include <span>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "engine/geometry/ray_scene.hpp"

namespace fascicle::muscle {

// A stretch of a line inside the mesh, by the line's t, m.
struct InsideInterval {
  double from = 0.0, to = 0.0;
};

class HeadRegion;

class FitSurface {
 public:
  // Keeps references to the mesh and the region. `sound`: closed, consistently turned, outward. With a region, inside
  // is what lies in both.
  FitSurface(const TriangleMesh& mesh, RayScene scene, bool sound, const HeadRegion* region = nullptr);
  ~FitSurface();

  const TriangleMesh& mesh() const { return mesh_; }
  // Closed loops of slices say what is inside.
  bool has_plain_slices() const { return sound_ && region_ == nullptr; }

  // Where each line enters first and leaves last.
  void cast(std::span<const Line> lines, std::span<LineExtremes> extremes) const;

  // The stretches of line i, by rising t: intervals[starts[i]] .. intervals[starts[i + 1]]. On a line that
  // crosses more than 64 triangles of a mesh that is not sound, inside is where it has entered more often than left,
  // counted from both ends: winding numbers would take too long where triangles make no surface.
  void find_inside(std::span<const Line> lines, std::vector<std::uint32_t>& starts,
                   std::vector<InsideInterval>& intervals) const;

  // The same of the mesh, whatever the region.
  void find_inside_mesh(std::span<const Line> lines, std::vector<std::uint32_t>& starts,
                        std::vector<InsideInterval>& intervals) const;

  // Whether some line so far met parts of the mesh that overlap, or are inside out.
  bool met_overlaps() const { return met_overlaps_; }

  // By winding number, and in the region.
  bool contains(const glm::dvec3& point) const;

 private:
  bool winds_round(const glm::dvec3& point) const;
  void cast_by_stretches(std::span<const Line> lines, std::span<LineExtremes> extremes) const;
  // The stretches of one line by winding number, given where it crosses the mesh.
  void append_by_winding(const Line& line, std::span<const LineCrossing> crossings,
                         std::vector<InsideInterval>& intervals) const;

  struct Winding;
  const TriangleMesh& mesh_;
  RayScene scene_;
  const HeadRegion* region_;
  bool sound_;
  mutable std::atomic<bool> met_overlaps_ = false;
  glm::dvec3 middle_;
  double reach_;  // m
  std::unique_ptr<Winding> winding_;
};

}  // namespace fascicle::muscle
