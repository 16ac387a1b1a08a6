// The fields of a character's bones, for collision: made from the bones' meshes, and kept beside the character file,
// NAME.bones.vdb next to NAME.character.json, so that loading need not build them again. The file is no content: it may
// be lost, broken or out of date at no harm but time; where the folder cannot be written, fields are built each time.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "engine/content/result.hpp"
#include "engine/content/triangle_mesh.hpp"
#include "modules/muscle/content/character_asset.hpp"

namespace fascicle::muscle {

// The file that keeps the fields of a character file.
std::filesystem::path bone_field_store_of(const std::filesystem::path& character_file);

// The meshes of each bone of the skeleton, in the bone's frame; none for a bone without.
std::vector<std::vector<TriangleMesh>> bone_surfaces(const CharacterAsset& asset);

// Fills asset.bone_fields from asset.bone_meshes. A bone whose field cannot be made has none, and a warning says why.
// Returns the number of fields that were built because the store had none; `rebuild`: all.
std::size_t load_bone_fields(const std::filesystem::path& character_file, CharacterAsset& asset,
                             Diagnostics& diagnostics, bool rebuild = false);

}  // namespace fascicle::muscle
