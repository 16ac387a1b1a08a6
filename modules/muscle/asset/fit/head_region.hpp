// The part of a mesh that belongs to one head of a muscle whose heads share the mesh: what lies nearer to the head's
// action line than to any other head's.
#pragma once

#include <span>
#include <vector>

#include <glm/vec3.hpp>

#include "modules/muscle/asset/fit/fit_surface.hpp"

namespace fascicle::muscle {

class HeadRegion {
 public:
  // Polylines through the heads' attachments, m; `own` is the number of this head's. Each piece costs, so they should
  // not be subdivided.
  HeadRegion(std::span<const std::vector<glm::dvec3>> lines, std::size_t own);

  // Neighbouring heads overlap a little, by a share of their distance from their lines, because each approximates the
  // border between them by facets of its own: else there were gaps.
  bool contains(const glm::dvec3& point) const;

  // Cuts the stretches of the line origin + t direction, from number `first` on, down to what lies in the region.
  void clip(const glm::dvec3& origin, const glm::dvec3& direction, std::size_t first,
            std::vector<InsideInterval>& intervals) const;

 private:
  std::vector<glm::dvec3> own_;
  std::vector<std::vector<glm::dvec3>> others_;
  double step_;  // m: borders nearer to each other along a line may be overlooked
};

}  // namespace fascicle::muscle
