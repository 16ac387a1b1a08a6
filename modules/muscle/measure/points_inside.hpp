// Whether points that belong inside a deforming surface are there: a muscle's fibres (4.4), asked of the surface's own
// triangles as they stand, by how often these wind round a point.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

#include "modules/muscle/asset/surface/surface_asset.hpp"
#include "modules/muscle/measure/solid_tree.hpp"

namespace fascicle::muscle {

struct PointsOutside {
  std::uint64_t count = 0;   // points that the surface does not wind round, or that are not finite
  double furthest = 0.0;     // m, of these from the surface
};

class InsideMeter {
 public:
  explicit InsideMeter(std::shared_ptr<const SurfaceAsset> asset);

  // `surface`: at least the asset's vertices, finite; both in one frame. In parallel on the caller's arena; the result
  // does not depend on it.
  PointsOutside measure(std::span<const SurfacePoint> surface, std::span<const SurfacePoint> points);

 private:
  std::shared_ptr<const SurfaceAsset> asset_;
  SolidTree tree_;
  std::vector<glm::vec3> places_;
};

}  // namespace fascicle::muscle
