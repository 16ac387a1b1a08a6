// A surface muscle's shape from the pose alone (4.5): no history, so any order of poses gives the same shapes.
//
// Input and output are those of position based dynamics (step_surface.hpp): of a SurfaceStep's motions only `to` is
// read, and of its points nothing.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

#include "modules/muscle/asset/hull/hull_asset.hpp"
#include "modules/muscle/kernels/hull/hull_kernels.hpp"
#include "modules/muscle/kernels/surface/step_surface.hpp"

namespace fascicle::muscle {

// Scratch of one muscle, allocated once.
struct HullScratch {
  std::vector<float> residuals;         // of the last pose, by iteration: how far it moved a hull vertex at most, as a
                                        // part of the muscle's size
  std::vector<float> refined;           // likewise of the full mesh's iterations and vertices
  std::vector<BoneTouch> touches;       // by bone it collides with
};
void lay_out(const SurfaceAsset& surface, const HullAsset& hull, HullScratch& scratch);

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
