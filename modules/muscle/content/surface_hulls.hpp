// The coarse hulls of a character's surface muscles: taken from the store beside the character file where they are up to
// date, else made, and turned into what the solver wants.
#pragma once

#include "modules/muscle/asset/hull/progressive_hull.hpp"
#include "modules/muscle/asset/surface/surface_description.hpp"
#include "modules/muscle/content/character_asset.hpp"
#include "modules/muscle/content/hull_store.hpp"

namespace fascicle::muscle {

// Whether a level of the muscle's is solved by its coarse hull.
bool uses_hull(const SurfaceMuscleDescription& muscle);

// What its hull is made to.
HullTarget hull_target(const SurfaceMuscleDescription& muscle);

// Fills asset.hulls, one a surface description; asset.surface_muscles are there. In parallel over muscles. What is wrong
// with a hull stands at its muscle's place in the file.
void build_hulls(const HullStore& store, CharacterAsset& asset, Diagnostics& diagnostics);

}  // namespace fascicle::muscle
