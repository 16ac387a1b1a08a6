// A surface muscle's shape from the pose alone (4.5): no history, so any order of poses gives the same shapes.
//
// Input and output are those of position based dynamics (step_surface.hpp): of a SurfaceStep's motions only `to` is
// read, and of its points nothing.
#pragma once

#include <cstdint>
#include <span>

#include <glm/vec3.hpp>

#include "modules/muscle/asset/hull/hull_asset.hpp"
#include "modules/muscle/kernels/hull/hull_kernels.hpp"
#include "modules/muscle/kernels/hull/hull_scratch.hpp"
#include "modules/muscle/kernels/surface/step_surface.hpp"

namespace fascicle::muscle {

struct HullPose {
  double volume = 0.0;                  // m^3
  std::uint32_t iterations = 0;
  bool converged = false;               // within the settings' tolerance
};

// `line`: where the points of HullAsset::line are now (m, simulation's frame). Writes step.points (places of vertices;
// inverse masses stay) and clears step.velocity.
HullPose pose_surface(const SurfaceStep& step, const HullAsset& hull, const HullKernels& kernels,
                      const HullSettings& settings, std::span<const glm::vec3> line, HullScratch& scratch);

}  // namespace fascicle::muscle
