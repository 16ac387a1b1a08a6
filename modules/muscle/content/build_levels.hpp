// The last step of loading a character: its muscles fitted and built at every level of detail.
#pragma once

#include <span>

#include "modules/muscle/content/character_asset.hpp"
#include "modules/muscle/content/fit_character.hpp"

namespace fascicle::muscle {

// Fills asset.fits, asset.levels and asset.muscles, and puts into asset.descriptions the levels that the fit chose. The
// descriptions must have passed the builder's checks.
void build_levels(std::span<const ResolvedMuscle> muscles, const FitSettings& settings, const FitStore& store,
                  CharacterAsset& asset, Diagnostics& diagnostics);

}  // namespace fascicle::muscle
