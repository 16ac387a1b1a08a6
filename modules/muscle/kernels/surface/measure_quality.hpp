// The figures of 4.3: how far a surface muscle is from its shape at rest. Plain code in double precision that shares
// nothing with the solver but the rest mesh; sums run in the order of triangles and hinges.
#pragma once

#include <span>

#include <glm/mat4x4.hpp>

#include "modules/muscle/asset/surface/surface_asset.hpp"
#include "modules/muscle/components/surface_muscle.hpp"

namespace fascicle::muscle {

// An edge counts as folded from this angle on (170 degrees): its triangles lie all but flat on each other.
inline constexpr double kFoldedAngle = 2.967;  // rad

// `points`: at least the asset's vertices, simulation's frame. `bones`: rest space to the simulation's frame, by bone;
// attached vertices whose bone is not among them do not count. Angles are followed from call to call, so that an edge
// whose triangles swing through each other is told from one that is bent the other way, until it is within a radian of
// its rest angle again: `quality` must have been used for this muscle alone. Allocates in the first call only.
void measure_quality(const SurfaceAsset& asset, std::span<const SurfacePoint> points, std::span<const glm::mat4> bones,
                     SurfaceQuality& quality);

}  // namespace fascicle::muscle
