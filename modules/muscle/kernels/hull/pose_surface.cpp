#include "modules/muscle/kernels/hull/pose_surface.hpp"

namespace fascicle::muscle {

void lay_out(const SurfaceAsset& surface, const HullAsset& hull, HullScratch& scratch) {
  scratch.residuals.reserve(hull.settings.iterations);
  scratch.touches.resize(surface.bones.size());
}

HullPose pose_surface(const SurfaceStep& step, const HullAsset&, const HullKernels&, const HullSettings&,
                      std::span<const glm::vec3>, HullScratch& scratch) {
  scratch.residuals.clear();
  SurfaceScratch carried;
  lay_out(*step.asset, carried);
  return {.volume = carry_rest_shape(step, carried), .iterations = 0, .converged = true};
}

}  // namespace fascicle::muscle
