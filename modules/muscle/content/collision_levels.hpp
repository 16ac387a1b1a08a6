// The collision of a character's muscles at all of its levels of detail, from its description and its bones' fields.
#pragma once

#include "modules/muscle/content/character_asset.hpp"

namespace fascicle::muscle {

// Fills asset.collision_levels; none where the character has no muscles.
void build_collision_levels(CharacterAsset& asset);

}  // namespace fascicle::muscle
