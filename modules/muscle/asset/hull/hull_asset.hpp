// A surface muscle's coarse hull as the solver wants it (4.5): the hull, the full mesh as weights of it, and everything
// that one iteration needs reduced to the hull beforehand. Immutable, shared. Lengths in metres, in the character's rest
// space.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include <glm/vec3.hpp>

#include "engine/content/result.hpp"
#include "engine/content/triangle_mesh.hpp"
#include "modules/muscle/asset/surface/surface_asset.hpp"
#include "modules/muscle/kernels/hull/dense_rows.hpp"

namespace fascicle::muscle {

// A point of the muscle's line: it goes with a bone, or with one of the surface asset's carriers.
struct HullLinePoint {
  glm::vec3 rest{0.0f};
  std::int32_t bone = -1;     // index into the skeleton; -1: `carrier`
  std::uint32_t carrier = 0;  // index in SurfaceAsset::carriers
};

struct HullAsset {
  HullSettings settings;
  std::vector<SurfaceLevel> levels;      // finest first
  std::vector<glm::vec3> rest;           // the hull's vertices
  std::vector<std::uint32_t> triangles;  // of the hull
  std::vector<HullLinePoint> line;       // 2 or more
  DenseRows weights;                     // W: full mesh = W * hull
};

// `surface` was built from `description`; `hull` encloses its mesh (build_progressive_hull); `muscles` has the driver.
// Errors: a hull that is no closed mesh, does not belong to the muscle (the coordinates do not reproduce its mesh), or
// is too large; no action line; a line without a length; settings out of range; no attachment at all.
Result<std::shared_ptr<const HullAsset>> build_hull_asset(const SurfaceAsset& surface,
                                                          const SurfaceMuscleDescription& description,
                                                          const TriangleMesh& hull,
                                                          const MuscleAsset* muscles = nullptr);

}  // namespace fascicle::muscle
