// What the last iterations on the full mesh need (HullFullMesh).
//
// Internal to asset/hull: it shows Eigen.
#pragma once

#include <span>

#include "modules/muscle/asset/hull/hull_asset.hpp"
#include "modules/muscle/asset/hull/shape_energy.hpp"

namespace fascicle::muscle {

// False where the free vertices' matrix has no factor.
bool build_full_mesh(const SurfaceAsset& surface, const ShapeEnergy& energy, HullFullMesh& full);

}  // namespace fascicle::muscle
