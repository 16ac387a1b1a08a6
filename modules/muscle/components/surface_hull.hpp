// State: what a surface muscle has that may be posed by its coarse hull (4.5), beside SurfaceMuscle and SurfaceState.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include <glm/vec3.hpp>

#include "engine/math/aligned_vector.hpp"
#include "modules/muscle/asset/hull/hull_asset.hpp"
#include "modules/muscle/kernels/hull/pose_surface.hpp"

namespace fascicle::muscle {

struct SurfaceHull {
  std::shared_ptr<const HullAsset> asset;
  HullSettings settings;                     // the asset's, until a game changes iterations, tolerance or refinements;
                                             // the others are built into the asset
  std::optional<SurfaceSolver> forced;       // a game's own choice, in place of the level of detail's
  SurfaceSolver solver = SurfaceSolver::kDynamic;  // of this step
  std::uint32_t refinements = 2;             // of this step
  std::uint32_t level = 0;                   // of asset->levels
  std::uint64_t switches = 0;                // of solvers, since the spawn
  float blend_time = 0.25f;                  // s: how long a change to the hull is blended; 0: it jumps
  float blend_left = 0.0f;                   // s
  bool changed = true;                       // the next pose is blended from the shape that the muscle has now
  AlignedVector<SurfacePoint> difference;    // m, by vertex: the old solver's place less the new one's at the change
  double volume_difference = 0.0;            // m^3, likewise
  glm::vec3 centre{0.0f};                    // m, rest space: the middle of the muscle's box
  std::vector<glm::vec3> line;               // m, simulation's frame: the action line's points now
  HullPose pose;                             // what the last pose took
  HullScratch scratch;
};

}  // namespace fascicle::muscle
