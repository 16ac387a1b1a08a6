// Checks content files as the loader does, by loading them: what fascicle-check runs.
#pragma once

#include <filesystem>

#include "engine/content/result.hpp"
#include "modules/muscle/content/character_asset.hpp"

namespace fascicle::muscle {

// Loads the file, a character or a scene (by its name, else by its members), with everything that it names; returns
// all errors and warnings. Of a collision file alone only the fields can be checked: check the character that names it.
Diagnostics check_content(const std::filesystem::path& file, const LoadOptions& options = {});

// Rewrites a file of an older version in the current one; a current one is left alone. Returns errors, or as warnings
// what was done.
Diagnostics migrate_content_file(const std::filesystem::path& file);

}  // namespace fascicle::muscle
