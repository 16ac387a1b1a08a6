// The coarse-hull solver's answer without a hull: the same energy, attachments, main direction and volume, solved on the
// full mesh in double precision, one rotation a vertex, by plain alternation of rotations and places from the same
// start to the same tolerance. What benchmarks measure the hull against and tests ask for the truth.
#pragma once

#include <memory>
#include <span>

#include <glm/vec3.hpp>

#include "modules/muscle/asset/hull/hull_asset.hpp"
#include "modules/muscle/kernels/hull/pose_surface.hpp"

namespace fascicle::muscle {

class PoseReference {
 public:
  PoseReference(const SurfaceAsset& surface, const HullAsset& hull);
  ~PoseReference();

  // As pose_surface; vertices that come into a bone are put on its surface in each iteration, by the shortest way.
  HullPose pose(const SurfaceStep& step, const HullSettings& settings, std::span<const glm::vec3> line) const;
  // The energy of places (m^2): what pose makes least, less attachments and the main direction.
  double energy(std::span<const SurfacePoint> points) const;

 private:
  struct Parts;
  std::unique_ptr<const Parts> parts_;
};

}  // namespace fascicle::muscle
