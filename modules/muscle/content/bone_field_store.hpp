// The fields of a character's bones: for collision, made from the bones' meshes.
#pragma once

#include <filesystem>

#include "engine/content/result.hpp"
#include "modules/muscle/content/character_asset.hpp"

namespace fascicle::muscle {

// Fills asset.bone_fields from asset.bone_meshes. A bone whose field cannot be made has none, and a warning says why.
void load_bone_fields(const std::filesystem::path& character_file, CharacterAsset& asset, Diagnostics& diagnostics);

}  // namespace fascicle::muscle
