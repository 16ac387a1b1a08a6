#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <numbers>
#include <span>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "engine/content/closest_name.hpp"
#include "engine/content/file_text.hpp"
#include "modules/muscle/content/character_asset.hpp"
#include "modules/muscle/content/find_content.hpp"
#include "modules/muscle/content/scene_asset.hpp"
#include "tools/fascicle_cook/commands.hpp"
#include "tools/fascicle_cook/fibres_report.hpp"
#include "tools/fascicle_cook/find_character.hpp"
#ifdef FASCICLE_COOK_PLAYS
#include "tools/fascicle_cook/fibres_play.hpp"
#endif

namespace fascicle::cook {
namespace {

namespace fs = std::filesystem;

struct Options {
  std::string input, muscle, method, arrangement, csv, svg;
  double pennation = -1.0;    // degrees; negative: as the content says
  std::uint32_t count = 0, points = 0;  // 0: likewise
  bool play = false;
  std::uint64_t every = 1;
};

void complain(const Options& options, std::string cause, std::string remedy) {
  print_diagnostics({.errors = {{options.input, 0, 0, {}, std::move(cause), std::move(remedy)}}, .warnings = {}});
}

// What was named, as a scene or as a character of its own.
struct Source {
  std::shared_ptr<const muscle::SceneAsset> scene;
  std::vector<std::shared_ptr<const muscle::CharacterAsset>> characters;
};

bool load(const Options& options, Source& source) {
  const fs::path scene_file = muscle::find_scene(options.input, muscle::find_content_folder());
  std::error_code error;
  if (fs::exists(scene_file, error) && scene_file.string().ends_with(".scene.json")) {
    const auto scene = muscle::load_scene(scene_file);
    print_diagnostics(scene.diagnostics());
    if (!scene) return false;
    source.scene = *scene;
    for (const muscle::SceneCharacter& character : source.scene->characters) {
      if (std::ranges::find(source.characters, character.character) == source.characters.end())
        source.characters.push_back(character.character);
    }
    return true;
  }
  const Result<fs::path> file = find_character(options.input);
  print_diagnostics(file.diagnostics());
  if (!file) return false;
  const auto character = muscle::load_character(*file, {.bone_fields = false});
  print_diagnostics(character.diagnostics());
  if (character) source.characters.push_back(*character);
  return character.ok();
}

// What the content asks for, changed by the options.
muscle::FibreBundleSettings choose(const Options& options, const muscle::SurfaceMuscleDescription& description) {
  muscle::FibreBundleSettings settings = description.fibre_bundle.value_or(muscle::FibreBundleSettings{});
  if (!options.method.empty()) {
    settings.method = options.method == "surface" ? muscle::FibreMethod::kSurface : muscle::FibreMethod::kIsocontour;
  }
  if (!options.arrangement.empty() && options.method.empty()) settings.method = muscle::FibreMethod::kIsocontour;
  if (options.arrangement == "parallel") settings.arrangement = muscle::FibreArrangement::kParallel;
  if (options.arrangement == "pennate") settings.arrangement = muscle::FibreArrangement::kPennate;
  if (options.arrangement == "fan") settings.arrangement = muscle::FibreArrangement::kFan;
  if (options.pennation >= 0.0) settings.pennation = static_cast<float>(options.pennation * std::numbers::pi / 180.0);
  if (options.count > 0) settings.count = options.count;
  if (options.points > 0) settings.points = options.points;
  return settings;
}

// The muscles asked for, with their fibres. What cannot be made is told of and left out.
std::vector<MuscleFibres> make(const Options& options, const Source& source, bool& whole) {
  std::vector<MuscleFibres> muscles;
  std::vector<std::string> names;
  for (const auto& character : source.characters) {
    for (std::size_t i = 0; i < character->surface_muscles.size(); ++i) {
      const auto& surface = character->surface_muscles[i];
      if (surface == nullptr) continue;
      names.push_back(surface->name);
      if (!options.muscle.empty() && surface->name != options.muscle) continue;
      const auto bundle = muscle::build_fibre_bundle(*surface, choose(options, character->surface_descriptions[i]));
      print_diagnostics(bundle.diagnostics());
      whole &= bundle.ok();
      if (bundle) muscles.push_back({surface, *bundle});
    }
  }
  if (names.empty()) {
    complain(options, "it has no surface muscle", "name a scene or a character that has one, such as 'hip-gluteus'");
    whole = false;
  } else if (!options.muscle.empty() && std::ranges::find(names, options.muscle) == names.end()) {
    complain(options, fmt::format("it has no surface muscle '{}'", options.muscle),
             suggest_name(options.muscle, std::span<const std::string>(names), "surface muscles"));
    whole = false;
  }
  return muscles;
}

bool write(const fs::path& file, const std::string& text) {
  const Diagnostics written = write_text_atomically(file, text);
  print_diagnostics(written);
  return written.ok();
}

// Several muscles' pictures go beside each other, with the muscles' names.
fs::path picture_file(const fs::path& file, const MuscleFibres& muscle, std::size_t count) {
  if (count < 2) return file;
  const std::string name = fmt::format("{}-{}", file.stem().string(), muscle.surface->name);
  return file.parent_path() / (name + file.extension().string());
}

bool play(const Options& options, const Source& source, std::span<const MuscleFibres> muscles) {
#ifdef FASCICLE_COOK_PLAYS
  if (source.scene == nullptr) {
    complain(options, "a character alone plays nothing", "name a scene (--play)");
    return false;
  }
  bool inside = true;
  for (const FibrePlay& one : play_fibres(source.scene, muscles, options.every)) {
    fmt::print("{}", to_table(one));
    inside &= one.outside == 0;
  }
  return inside;
#else
  (void)source;
  (void)muscles;
  complain(options, "this program was built without the game's simulation",
           "build with FASCICLE_BUILD_RENDER=ON, or leave --play out");
  return false;
#endif
}

int fibres(const Options& options) {
  Source source;
  if (!load(options, source)) return kErrors;
  bool fine = true;
  const std::vector<MuscleFibres> muscles = make(options, source, fine);
  for (const MuscleFibres& muscle : muscles) fmt::print("{}", fibres_table(muscle));
  if (!options.csv.empty()) fine &= write(options.csv, fibres_csv(muscles));
  if (!options.svg.empty()) {
    for (const MuscleFibres& muscle : muscles)
      fine &= write(picture_file(options.svg, muscle, muscles.size()), fibres_svg(muscle));
  }
  if (options.play && !muscles.empty()) fine &= play(options, source, muscles);
  return fine ? kFine : kErrors;
}

}  // namespace

void add_fibres(CLI::App& program, Command& chosen) {
  auto options = std::make_shared<Options>();
  CLI::App* command = program.add_subcommand("fibres", "Make fibres inside surface muscles and measure them");
  command->add_option("INPUT", options->input, "A scene's or a character's name or file")->required();
  command->add_option("--muscle", options->muscle, "This surface muscle alone (all)");
  command->add_option("--method", options->method, "How they are made (as the content says; isocontours)")
      ->check(CLI::IsMember({"isocontours", "isocontour", "surface"}));
  command->add_option("--template", options->arrangement, "Isocontours in this arrangement (as the content says)")
      ->check(CLI::IsMember({"parallel", "pennate", "fan"}));
  command->add_option("--pennation", options->pennation, "Degrees between pennate fibres and the muscle's line (20)")
      ->check(CLI::Range(0.0, 85.0));
  command->add_option("--count", options->count, "Fibres (1000)")->check(CLI::Range(1, 100000));
  command->add_option("--points", options->points, "Points of each (10)")->check(CLI::Range(2, 1000));
  command->add_option("--csv", options->csv, "Write every point to this file");
  command->add_option("--svg", options->svg, "Write a picture of the fibres at rest to this file");
  command->add_flag("--play", options->play, "Play the scene and ask at its steps whether every point is inside");
  command->add_option("--every", options->every, "Ask at every so many steps (1)")->check(CLI::Range(1, 1000000));
  command->footer("Exit status 1, too, where fibres cannot be made or, with --play, leave their muscle.");
  command->callback([options, &chosen] { chosen = [options] { return fibres(*options); }; });
}

}  // namespace fascicle::cook
