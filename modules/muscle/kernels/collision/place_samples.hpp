// Vertices and samples of all surfaces from centres, directions and radii, and the boxes that the broad phase needs.
#pragma once

#include "modules/muscle/asset/collision/collision_asset.hpp"
#include "modules/muscle/kernels/collision/collision_work.hpp"

namespace fascicle::muscle {

// u, v -> the directions e_i = cos theta_i u + sin theta_i v of all vertices; once a step.
void place_directions(const CollisionAsset& asset, CollisionWork& work);

// a, radii, directions -> vertices, samples, boxes.
void place_samples(const CollisionAsset& asset, CollisionWork& work);

}  // namespace fascicle::muscle
