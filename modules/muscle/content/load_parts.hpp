// The steps of `load_character` after the files are read, one kind of part each. All append errors and go on.
#pragma once

#include <filesystem>
#include <span>

#include "modules/muscle/content/character_asset.hpp"
#include "modules/muscle/content/character_file.hpp"
#include "modules/muscle/content/content_sources.hpp"
#include "modules/muscle/content/resolve_collision.hpp"
#include "modules/muscle/content/resolve_muscles.hpp"

namespace fascicle::muscle {

// As the public load_character, with the files of a larger load; `files` of the answer are all of theirs so far.
Result<std::shared_ptr<const CharacterAsset>> load_character(const std::filesystem::path& file,
                                                             const LoadOptions& options, ContentSources& sources);

// Keeps the first of errors, and of warnings, that say the same of the same place.
void drop_repetitions(Diagnostics& diagnostics);

// `base` is the folder of `file`. Bones of a skin in another glTF file than the skeleton's are found by name.
void load_skins(const CharacterFile& file, const std::filesystem::path& base, ContentSources& sources,
                CharacterAsset& asset, Diagnostics& diagnostics);
void load_bone_meshes(const CharacterFile& file, const std::filesystem::path& base, ContentSources& sources,
                      CharacterAsset& asset, Diagnostics& diagnostics);

// Meshes of those `muscles` that `file` describes and that name one. A mirror image whose own mesh is not in the file
// takes its original's, reflected.
void load_muscle_meshes(const CharacterFile& file, const std::filesystem::path& base,
                        std::span<const ResolvedMuscle> muscles, ContentSources& sources, CharacterAsset& asset,
                        Diagnostics& diagnostics);

// Appends the surface muscles of one file to asset.surface_descriptions, a mirror image after its original;
// asset.descriptions and bone_meshes are there. `names` are those of surface muscles so far and grows.
void load_surface_muscles(const CharacterFile& file, const std::filesystem::path& base, ContentSources& sources,
                          MuscleNames& names, CharacterAsset& asset, Diagnostics& diagnostics);

// Fills asset.surface_muscles from their descriptions. asset.muscles is there, for those that are driven.
void build_surface_muscles(CharacterAsset& asset, Diagnostics& diagnostics);

// The other side of asset.descriptions and asset.skeleton.
MirrorMap make_mirror_map(const MirrorRule& rule, const CharacterAsset& asset);

// The collision file that `file` names, its names looked up among asset.descriptions and asset.skeleton; `names` are
// those of all muscles, `mirror` the rule to mirror by. Images are yet to be placed.
ResolvedCollision load_collision(const CharacterFile& file, const std::filesystem::path& base, const MirrorRule& mirror,
                                 const MuscleNames& names, ContentSources& sources, const CharacterAsset& asset,
                                 Diagnostics& diagnostics);

}  // namespace fascicle::muscle
