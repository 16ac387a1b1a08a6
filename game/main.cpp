// fascicle: the game. Loads a scene and its characters, registers the systems and runs them, in a window or headless.

#include <cstdio>

#include "engine/content/run_program.hpp"
#include "game/game_options.hpp"
#include "game/run_headless.hpp"
#include "game/run_window.hpp"
#include "game/simulation.hpp"
#include "modules/muscle/content/find_content.hpp"
#include "modules/muscle/content/scene_asset.hpp"

namespace {

using namespace fascicle;

int run(int argc, char** argv) {
  const game::ParsedOptions parsed = game::parse_options(argc, argv);
  if (parsed.exit_status) return *parsed.exit_status;
  const game::GameOptions& options = parsed.options;

  const std::filesystem::path content = muscle::find_content_folder();
  const std::filesystem::path file = muscle::find_scene(options.scene, content);
  const auto scene = muscle::load_scene(file);
  if (!scene) {
    std::fputs(to_text(scene.diagnostics()).c_str(), stderr);
    if (!muscle::lacks_data(scene.diagnostics())) return game::kExitBadContent;
    std::fprintf(stderr,
                 "The scene '%s' needs data that is not part of the project; set FASCICLE_DATA to its folder.\n",
                 options.scene.c_str());
    return game::kExitNoData;
  }
  if (!scene.diagnostics().warnings.empty()) std::fputs(to_text(scene.diagnostics()).c_str(), stderr);

  if (options.print_schedule || options.print_dot) {
    game::SimulationOptions bare;
    bare.workers = 1;
    game::Simulation simulation(*scene, bare);
    std::fputs((options.print_dot ? simulation.schedule().to_dot() : simulation.schedule().to_text()).c_str(), stdout);
    return game::kExitOk;
  }
  return options.headless ? game::run_headless(options, *scene) : game::run_window(options, file, *scene);
}

}  // namespace

int main(int argc, char** argv) {
  return fascicle::run_program("fascicle", [&] { return run(argc, argv); }, fascicle::game::kExitNoOutput);
}
