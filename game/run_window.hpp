// A run in a window: fixed steps behind a picture that interpolates, camera and overlay, and live reload of the content
// files. It ends when the window is closed, or after the frames that were asked for.
#pragma once

#include <filesystem>
#include <memory>

#include "game/game_options.hpp"
#include "modules/muscle/content/scene_asset.hpp"

namespace fascicle::game {

// Returns the program's exit status.
int run_window(const GameOptions& options, const std::filesystem::path& scene_file,
               std::shared_ptr<const muscle::SceneAsset> scene);

}  // namespace fascicle::game
