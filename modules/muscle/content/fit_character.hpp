// Fits the muscles of a character that is being loaded to their meshes, at all of its levels of detail, unless a stored
// fit of the same inputs is at hand.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "modules/muscle/content/character_asset.hpp"
#include "modules/muscle/content/fit_store.hpp"
#include "modules/muscle/content/resolve_muscles.hpp"

namespace fascicle::muscle {

struct FitSettings {
  bool enabled = true;               // false: as if no muscle had a mesh
  std::uint32_t supersampling = 3;   // CSS
  std::uint32_t coarser_levels = 2;  // at most
};

// One answer a muscle, in the order of `muscles`, which are those of asset.descriptions; the asset's skeleton, bone
// meshes and muscle meshes are read. Where the fit chooses the level, it is the first of the answer's. Muscles without a
// mesh have levels with empty fits. Warnings are appended; stored fits repeat theirs.
std::vector<MuscleFits> fit_character(std::span<const ResolvedMuscle> muscles, const CharacterAsset& asset,
                                      const FitStore& store, const FitSettings& settings, Diagnostics& diagnostics);

}  // namespace fascicle::muscle
