// A deformed mesh as it is drawn: its vertices in world space with unit normals.
//
// A vertex' normal is the sum of (p_b - p_a) x (p_c - p_a) over its triangles, so a triangle counts by its area. The
// sums gather, triangle after triangle, in the very records that become the vertices: no scratch memory, and the same
// bits every time.
#pragma once

#include <cstdint>
#include <span>

#include <glm/mat4x4.hpp>

#include "modules/muscle/asset/surface/surface_asset.hpp"
#include "modules/muscle/components/muscle_surfaces.hpp"

namespace fascicle::muscle {

// `points` has at least as many as `vertices`, which `triangles` (anticlockwise from outside) count; `frame` takes them
// to the world. A vertex whose triangles have no area, or cancel each other out, gets the frame's y axis as its normal.
void write_surface_vertices(std::span<const std::uint32_t> triangles, std::span<const SurfacePoint> points,
                            const glm::mat4& frame, std::span<SurfaceVertex> vertices);

}  // namespace fascicle::muscle
