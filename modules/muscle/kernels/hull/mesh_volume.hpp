// A closed mesh's volume and how it changes as its vertices move (4.1).
#pragma once

#include <cstdint>
#include <span>

#include "modules/muscle/asset/surface/surface_asset.hpp"

namespace fascicle::muscle {

// m^3. `gradient` (m^2, by vertex): of the volume by each vertex' place; empty: it is not wanted. Places are taken from
// the first vertex, so that a muscle far from the origin loses nothing.
double measure_volume(std::span<const std::uint32_t> triangles, std::span<const SurfacePoint> points,
                      std::span<SurfacePoint> gradient);

}  // namespace fascicle::muscle
