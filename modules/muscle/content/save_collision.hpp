// Saves tags to a character's collision file, which is made, and named in the character file, where there is none.
// Files are replaced as a whole or not at all; what is in them otherwise stays byte for byte.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "engine/content/result.hpp"
#include "modules/muscle/content/character_asset.hpp"

namespace fascicle::muscle {

// The collision file that a character file names; where it names none, the one that saving would make beside it,
// NAME.collision.json. Errors: the character file cannot be read, the reference leads nowhere.
struct CollisionFilePlace {
  std::filesystem::path file;
  bool named = false;
};
Result<CollisionFilePlace> find_collision_file(const std::filesystem::path& character_file,
                                               const std::filesystem::path& data_folder = {});

struct SavedCollision {
  std::filesystem::path file;
  bool changed = false;        // a file was written
  bool named_anew = false;     // the reference was added to the character file
};

// Adds an author's tag (a click on two sections) at the end of the file's transversals. Without `mirror` it stands for
// both sides where there are both. Errors: places or muscles that do not exist, a muscle with itself, places that are
// tagged already, a file that is not what it should be.
Result<SavedCollision> save_transversal(const std::filesystem::path& character_file, const CharacterAsset& character,
                                        const TransversalTag& tag, std::optional<bool> mirror = std::nullopt,
                                        const std::filesystem::path& data_folder = {});

// Replaces the entries that are marked automatic by these (JSON, as write_entry gives them); nothing else changes, and
// nothing at all where they are there already. `write` false: only tells what would happen.
struct AutomaticEntries {
  std::vector<std::string> transversals, stay_out;
};
Result<SavedCollision> save_automatic(const std::filesystem::path& character_file, const AutomaticEntries& entries,
                                      bool write = true, const std::filesystem::path& data_folder = {});

}  // namespace fascicle::muscle
