#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "engine/animation/clip.hpp"
#include "engine/animation/motion.hpp"
#include "engine/content/closest_name.hpp"
#include "engine/content/file_text.hpp"
#include "modules/muscle/content/find_content.hpp"
#include "tools/fascicle_cook/collide_extremes.hpp"
#include "tools/fascicle_cook/collide_report.hpp"
#include "tools/fascicle_cook/collide_run.hpp"
#include "tools/fascicle_cook/commands.hpp"
#include "tools/fascicle_cook/find_character.hpp"

namespace fascicle::cook {
namespace {

namespace fs = std::filesystem;

// CLI::Range lets NaN through.
CLI::Validator within(double lowest, double highest) {
  return CLI::Range(lowest, highest) & CLI::Validator([](std::string& text) {
           return std::isfinite(std::strtod(text.c_str(), nullptr)) ? std::string() : "'" + text + "' is not finite";
         }, "");
}

struct Options {
  std::string source, clip, csv;
  std::vector<std::string> modes{"without", "with", "legacy"};
  std::uint64_t frames = 0, every = 0;
  double hz = 0.0, cycles = 10.0;
  int pairs = 0, threads = 0, level = -1;
  bool json = false, extremes = false;
  std::string only;
};

// The scene of that name or file, or one made for a character's file: its clip, on the spot.
std::shared_ptr<const muscle::SceneAsset> load(const Options& options) {
  auto scene = std::make_shared<muscle::SceneAsset>();
  const fs::path scene_file = muscle::find_scene(options.source, muscle::find_content_folder());
  std::error_code ignored;
  if (scene_file.string().ends_with(".scene.json") && fs::exists(scene_file, ignored)) {
    const auto loaded = muscle::load_scene(scene_file);
    print_diagnostics(loaded.diagnostics());
    if (!loaded) return nullptr;
    *scene = **loaded;
  } else {
    const auto file = find_character(options.source);
    if (!file) {
      print_diagnostics(file.diagnostics());
      return nullptr;
    }
    const auto character = muscle::load_character(*file);
    print_diagnostics(character.diagnostics());
    if (!character) return nullptr;
    scene->name = (*character)->name;
    scene->characters.resize(1);
    scene->characters[0].character = *character;
    scene->characters[0].in_place = true;
    if (!(*character)->clips.empty()) scene->characters[0].animation.clip = (*character)->clips.front();
  }
  if (options.hz > 0.0) scene->step_hz = static_cast<float>(options.hz);
  const auto refuse = [&](const std::string& what, const std::string& remedy) {
    print_diagnostics({.errors = {{options.source, 0, 0, {}, what, remedy}}, .warnings = {}});
    return nullptr;
  };
  if (scene->characters.empty() || !scene->characters[0].character->muscles) {
    return refuse("the first character has no muscles", "name a character that has some");
  }
  if (!options.clip.empty()) {
    std::vector<std::string> names;
    muscle::AnimationChoice& animation = scene->characters[0].animation;
    animation.clip = nullptr;
    for (const auto& clip : scene->characters[0].character->clips) {
      names.push_back(clip->name);
      if (clip->name == options.clip) animation.clip = clip;
    }
    if (animation.clip == nullptr) {
      return refuse(fmt::format("there is no clip '{}'", options.clip), suggest_name(options.clip, names, "clips"));
    }
    animation.motion = nullptr;
  }
  return scene;
}

std::uint64_t frames_of(const Options& options, const muscle::SceneAsset& scene) {
  if (options.frames > 0) return options.frames;
  const muscle::AnimationChoice& animation = scene.characters[0].animation;
  const double length = animation.clip     ? static_cast<double>(animation.clip->duration())
                        : animation.motion ? animation.motion->cycle.length()
                                           : 1.0;
  const double speed = std::max(std::abs(static_cast<double>(animation.speed)), 1e-3);
  return static_cast<std::uint64_t>(
      std::clamp(std::ceil(options.cycles * length / speed * static_cast<double>(scene.step_hz)), 1.0, 1e6));
}

int collide(const Options& options) {
  const auto scene = load(options);
  if (scene == nullptr) return kErrors;
  std::vector<CollideMode> modes;
  for (const std::string& mode : options.modes) {
    for (const CollideMode known : {CollideMode::kWithout, CollideMode::kWith, CollideMode::kLegacy}) {
      if (mode == to_string(known)) modes.push_back(known);
    }
  }
  if (options.extremes) {
    const std::uint64_t every = options.every > 0 ? options.every : ExtremeOptions{}.every;
    fmt::print("{}", to_table(run_extremes(*scene, modes, {.every = every, .workers = options.threads}, options.only)));
    return kFine;
  }
  CollideOptions run{.frames = frames_of(options, *scene), .every = std::max<std::uint64_t>(options.every, 1),
                     .level = {}, .workers = options.threads};
  if (options.level >= 0) run.level = static_cast<std::uint32_t>(options.level);
  const CollideReport report = run_collide(scene, modes, run);
  if (options.json) {
    fmt::print("{}", to_json(report));
  } else {
    fmt::print("{}\n", to_table(report));
    if (options.pairs > 0) fmt::print("\n{}", to_pair_tables(report, static_cast<std::size_t>(options.pairs)));
  }
  if (options.csv.empty()) return kFine;
  const Diagnostics written = write_text_atomically(options.csv, to_csv(report));
  print_diagnostics(written);
  return written.ok() ? kFine : kErrors;
}

}  // namespace

void add_collide(CLI::App& program, Command& chosen) {
  auto options = std::make_shared<Options>();
  CLI::App* command = program.add_subcommand(
      "collide", "Play a character and measure how deep its muscles are in bones and in each other");
  command->add_option("CHARACTER", options->source,
                      "A scene's name or file (its first character), or else a character's (its first clip)")
      ->required();
  command->add_option("--clip", options->clip, "This clip of the character");
  command->add_option("--frames", options->frames, "Steps (those of --cycles)");
  command->add_option("--hz", options->hz, "Steps a second (the scene's)")->check(within(1.0, 1000.0));
  command->add_option("--cycles", options->cycles, "Lengths of the animation (10)")->check(within(0.01, 1e4));
  command->add_option("--every", options->every, "Measure one step in so many (1; of extremes 6)")
      ->check(CLI::Range(1, 1000000));
  command->add_option("--modes", options->modes, "Of: without, with, legacy (all that the character has)")
      ->delimiter(',')
      ->check(CLI::IsMember({"without", "with", "legacy"}));
  command->add_option("--level", options->level, "Level of detail (0, the finest)")->check(CLI::Range(0, 64));
  command->add_option("--pairs", options->pairs, "List so many of the worst pairs, of bones and of muscles (20)")
      ->expected(0, 1)
      ->default_str("20")
      ->check(CLI::Range(1, 10000));
  command->add_flag("--extremes", options->extremes,
                    "Disturb the walk instead: sweeps, muscles beyond a bone, teleports, pauses, long frames");
  command->add_option("--only", options->only, "With --extremes: those alone with this in their names");
  command->add_flag("--json", options->json, "Print the figures as JSON in place of tables");
  command->add_option("--csv", options->csv, "Write the figures of every measured step to this file");
  command->add_option("--threads", options->threads, "Workers (one for each core)")->check(CLI::Range(0, 256));
  command->callback([options, &chosen] { chosen = [options] { return collide(*options); }; });
}

}  // namespace fascicle::cook
