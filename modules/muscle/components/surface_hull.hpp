// State: what a surface muscle has that may be posed by its coarse hull (4.5), beside SurfaceMuscle and SurfaceState.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include <glm/vec3.hpp>

#include "engine/math/aligned_vector.hpp"
#include "modules/muscle/asset/hull/hull_asset.hpp"
#include "modules/muscle/kernels/hull/pose_surface.hpp"

namespace fascicle::muscle {

struct SurfaceHull {
  std::shared_ptr<const HullAsset> asset;
  HullSettings settings;                     // the asset's, until a game changes them
  SurfaceSolver solver = SurfaceSolver::kDynamic;  // of this step
  std::uint32_t refinements = 2;             // of this step
  std::uint32_t level = 0;                   // of asset->levels
  std::uint64_t switches = 0;                // of solvers, since the spawn
  float blend_time = 0.25f;                  // s: how long a change of solver is blended; 0: it jumps
  float blend_left = 0.0f;                   // s
  AlignedVector<SurfacePoint> difference;    // m, by vertex: the old solver's place less the new one's at the change
  std::vector<glm::vec3> line;               // m, simulation's frame: the action line's points now
  HullPose pose;                             // what the last pose took
  HullScratch scratch;
};

}  // namespace fascicle::muscle
