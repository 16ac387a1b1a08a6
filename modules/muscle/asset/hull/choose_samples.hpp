// The part of a muscle's vertices that the coarse hull's iterations look at (HullSamples).
#pragma once

#include "modules/muscle/asset/hull/hull_asset.hpp"

namespace fascicle::muscle {

inline constexpr std::uint32_t kMostSamples = 1500;

// Vertices, triangles and volume; all vertices where the mesh has no more than kMostSamples.
HullSamples choose_samples(const SurfaceAsset& surface);

}  // namespace fascicle::muscle
