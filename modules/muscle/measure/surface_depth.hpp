// How deep a surface muscle is in bones, and how well its attached vertices follow theirs, found without the solver's
// fields and carriers: all its triangles are cut into points about a millimetre apart, which ask the bones' original
// triangles for the closest point and the winding number (bone_solids.hpp).
//
// Attached vertices are in their bone's surface on purpose. Triangles that touch one of them or one of their neighbours
// therefore count apart.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include <glm/mat4x4.hpp>

#include "modules/muscle/asset/surface/surface_asset.hpp"
#include "modules/muscle/measure/bone_solids.hpp"

namespace fascicle::muscle {

inline constexpr float kSurfaceSpacing = 0.001f;  // m

// The deepest point of a part of the surface.
struct SurfaceDepth {
  double depth = 0.0;      // m; 0: it is in no bone
  glm::vec3 place{0.0f};   // m, world
  std::int32_t bone = -1;
  std::uint32_t triangle = 0;
};

struct SurfaceDepths {
  SurfaceDepth free;          // triangles that touch neither attached vertices nor neighbours of them
  SurfaceDepth beside;        // those that touch neighbours, but no attached vertex
  std::uint64_t points = 0;   // near enough to a bone to be asked, once a bone
  bool finite = true;         // false: some vertex was not, and its triangles were left out
};

class SurfaceDepthMeter {
 public:
  SurfaceDepthMeter(std::shared_ptr<const SurfaceAsset> asset, std::shared_ptr<const BoneSolids> bones,
                    float spacing = kSurfaceSpacing);

  // `points`: at least the asset's vertices; `frame` takes them to the world, `bones` (rigid) the bones' own frames.
  // In parallel on the caller's arena; the result does not depend on it.
  SurfaceDepths measure(std::span<const SurfacePoint> points, const glm::mat4& frame,
                        std::span<const glm::mat4> bones) const;

 private:
  std::shared_ptr<const SurfaceAsset> asset_;
  std::shared_ptr<const BoneSolids> bones_;
  float spacing_;
  std::vector<std::uint8_t> near_attached_;  // by triangle: 0 free, 1 beside, 2 touches an attached vertex
};

// By attachment: the furthest that one of its vertices is (m) from where its bone's motion since rest has brought its
// place at rest. `rest_bones` and `bones`: bone to world, at rest and now. Infinity where a vertex is not finite.
std::vector<double> attachment_errors(const SurfaceAsset& asset, std::span<const SurfacePoint> points,
                                      const glm::mat4& frame, std::span<const glm::mat4> rest_bones,
                                      std::span<const glm::mat4> bones);

}  // namespace fascicle::muscle
