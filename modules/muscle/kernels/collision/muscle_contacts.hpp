// Which samples of one muscle are in another, or about to be: a sparse voxel grid finds the segments of other muscles
// that a row of samples may touch, the outline in each sample's plane says how deep it is. Linear in the sections.
#pragma once

#include "modules/muscle/asset/collision/collision_asset.hpp"
#include "modules/muscle/kernels/collision/collision_work.hpp"

namespace fascicle::muscle {

// Sorts the segments' boxes into the grid's cells.
void fill_grid(const CollisionAsset& asset, CollisionWork& work);

// Appends contacts for samples less than `reach` (m) away from being as deep as they are at rest, less `margin` (m).
// After fill_grid. `at_rest`: all samples are looked at as those are that overlap at rest.
void find_muscle_contacts(const CollisionAsset& asset, float margin, float reach, bool at_rest, CollisionWork& work);

}  // namespace fascicle::muscle
