// How two muscles lie at rest: anatomical meshes overlap, and what overlaps at rest may.
#pragma once

#include <vector>

#include "modules/muscle/asset/surface/surface_asset.hpp"

namespace fascicle::muscle {

// m, by vertex of `muscle`: how far it is at rest from the surface of `other`; negative inside of it. No more than
// `reach` (m, > 0). Both meshes lie in the character's rest space.
std::vector<float> find_rest_clearance(const SurfaceAsset& muscle, const SurfaceAsset& other, float reach);

}  // namespace fascicle::muscle
