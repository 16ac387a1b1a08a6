// The loader of scenes as live reload uses it: it tells which files a load looked at, whether it went well or not.
#pragma once

#include <filesystem>
#include <vector>

#include "modules/muscle/content/scene_asset.hpp"

namespace fascicle::muscle {

// As the public load_scene. `files` becomes every file that was read or looked for, each once, the scene file first.
Result<std::shared_ptr<const SceneAsset>> load_scene(const std::filesystem::path& file, const LoadOptions& options,
                                                     std::vector<std::filesystem::path>& files);

// The same for a character.
Result<std::shared_ptr<const CharacterAsset>> load_character(const std::filesystem::path& file,
                                                             const LoadOptions& options,
                                                             std::vector<std::filesystem::path>& files);

}  // namespace fascicle::muscle
