// A run without a window: so many steps as fast as they go, then the files that were asked for and the time per system.
#pragma once

#include <memory>

#include "game/game_options.hpp"
#include "modules/muscle/content/scene_asset.hpp"

namespace fascicle::game {

// Returns the program's exit status.
int run_headless(const GameOptions& options, std::shared_ptr<const muscle::SceneAsset> scene);

}  // namespace fascicle::game
