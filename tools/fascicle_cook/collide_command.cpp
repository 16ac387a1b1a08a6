#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "engine/animation/clip.hpp"
#include "engine/animation/motion.hpp"
#include "engine/animation/skeleton.hpp"
#include "engine/content/closest_name.hpp"
#include "engine/content/file_text.hpp"
#include "modules/muscle/asset/muscle_asset.hpp"
#include "modules/muscle/content/find_content.hpp"
#include "tools/fascicle_cook/collide_run.hpp"
#include "tools/fascicle_cook/commands.hpp"
#include "tools/fascicle_cook/find_character.hpp"

namespace fascicle::cook {
namespace {

namespace fs = std::filesystem;
using muscle::PairDepth;

struct Options {
  std::string source, clip, csv;
  std::vector<std::string> modes{"without", "with", "legacy"};
  std::uint64_t frames = 0, every = 1;
  double hz = 0.0, cycles = 10.0;
  int pairs = 0, threads = 0, level = -1;
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

std::string name_of(const CollideReport& report, const PairDepth& pair) {
  if (!(pair.depth > 0.0f)) return "-";
  const std::string other = pair.bone >= 0
                                ? report.character->skeleton->names[static_cast<std::size_t>(pair.bone)]
                                : report.asset->muscles[pair.other].name;
  return report.asset->muscles[pair.muscle].name + " in " + other;
}

double mm(float metres) { return 1e3 * static_cast<double>(metres); }

// The frame of a run's worst, of those that count.
template <class F>
const CollideFrame* worst(const CollideRun& run, std::uint64_t first, F value) {
  const CollideFrame* found = nullptr;
  for (const CollideFrame& frame : run.frames) {
    if (frame.frame >= first && (found == nullptr || value(frame) > value(*found))) found = &frame;
  }
  return found;
}

constexpr const char* kRow = "{:<10}{:>8.2f}  {:<46}{:>8.2f}  {:<46}{:>7.2f}{:>8.2f}{:>9.2f}{:>8.2f}{:>8.2f}%{:>7}{:>7}{:>10.5f}\n";

std::string to_table(const CollideReport& report, std::uint64_t first) {
  std::string text = fmt::format("{:<10}{:>8}  {:<46}{:>8}  {:<46}{:>7}{:>8}{:>9}{:>8}{:>9}{:>7}{:>7}{:>10}\n", "mm",
                                 "in bone", "deepest (frame)", "muscle", "deepest (frame)", "bone+", "by pair",
                                 "muscle+", "by pair", "area", "fallb.", "held", "jitter");
  const PairDepth rest_bone = deepest(report.rest.bones), rest_muscle = deepest(report.rest.muscles);
  text += fmt::format(fmt::runtime(kRow), "rest", mm(rest_bone.depth), name_of(report, rest_bone),
                      mm(rest_muscle.depth), name_of(report, rest_muscle), 0.0, 0.0, 0.0, 0.0, 0.0, 0, 0, 0.0);
  for (const CollideRun& run : report.runs) {
    const CollideFrame* bone = worst(run, first, [](const CollideFrame& f) { return f.bone.depth; });
    if (bone == nullptr) continue;
    const CollideFrame* other = worst(run, first, [](const CollideFrame& f) { return f.muscle.depth; });
    const auto most = [&](auto value) { return value(*worst(run, first, value)); };
    text += fmt::format(
        fmt::runtime(kRow), to_string(run.mode), mm(bone->bone.depth),
        fmt::format("{} ({})", name_of(report, bone->bone), bone->frame), mm(other->muscle.depth),
        fmt::format("{} ({})", name_of(report, other->muscle), other->frame),
        mm(most([](const CollideFrame& f) { return f.beyond.bone; })),
        mm(most([](const CollideFrame& f) { return f.beyond.bone_pair; })),
        mm(most([](const CollideFrame& f) { return f.beyond.muscle; })),
        mm(most([](const CollideFrame& f) { return f.beyond.muscle_pair; })),
        100.0 * static_cast<double>(most([](const CollideFrame& f) { return f.area.relative; })),
        run.frames.back().fallbacks, run.frames.back().held, 1e3 * run.jitter_rms);
  }
  for (const CollideRun& run : report.runs) {
    text += fmt::format("{}: {} frames measured, {:.2f} ms a step, {:.1f} ms a measure", to_string(run.mode),
                        run.frames.size(), run.step_ms, run.measure_ms);
    if (run.unstable > 0) text += fmt::format(", NOT FINITE in {}", run.unstable);
    const CollideFrame* area = worst(run, first, [](const CollideFrame& f) { return f.area.relative; });
    if (area != nullptr && area->area.relative > 0.0f) {
      text += fmt::format(", worst area {} section {} (frame {})", report.asset->muscles[area->area.muscle].name,
                          area->area.section, area->frame);
    }
    text += '\n';
  }
  return text;
}

std::string pair_table(const CollideReport& report, const std::vector<CollidePair>& pairs, int count) {
  std::string text = fmt::format("  {:<50}{:>8}{:>8}{:>8}{:>8}{:>10}{:>9}\n", "pair", "mm", "at rest", "beyond", "frame",
                                 "fraction", "section");
  for (const bool bones : {true, false}) {
    int left = count;
    for (const CollidePair& pair : pairs) {
      if ((pair.deepest.bone >= 0) != bones) continue;
      if (left-- <= 0) break;
      const auto& layout = report.asset->muscles[pair.deepest.muscle];
      text += fmt::format("  {:<50}{:>8.2f}{:>8.2f}{:>8.2f}{:>8}{:>10.3f}{:>6.1f}/{:<2}\n", name_of(report, pair.deepest),
                          mm(pair.deepest.depth), mm(pair.rest), mm(pair.deepest.depth - pair.rest), pair.frame,
                          pair.deepest.place / static_cast<float>(layout.section_count - 1), pair.deepest.place,
                          layout.section_count - 1);
    }
  }
  return text;
}

std::string to_csv(const CollideReport& report) {
  std::string text =
      "mode,frame,bone_deepest_mm,bone_pair,muscle_deepest_mm,muscle_pair,bone_max_mm,bone_pair_max_mm,muscle_max_mm,"
      "muscle_pair_max_mm,section_area_error_max,fallbacks,held\n";
  for (const CollideRun& run : report.runs) {
    for (const CollideFrame& f : run.frames) {
      text += fmt::format("{},{},{:.4f},{},{:.4f},{},{:.4f},{:.4f},{:.4f},{:.4f},{:.6f},{},{}\n", to_string(run.mode),
                          f.frame, mm(f.bone.depth), name_of(report, f.bone), mm(f.muscle.depth),
                          name_of(report, f.muscle), mm(f.beyond.bone), mm(f.beyond.bone_pair), mm(f.beyond.muscle),
                          mm(f.beyond.muscle_pair), f.area.relative, f.fallbacks, f.held);
    }
  }
  return text;
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
  CollideOptions run{.frames = frames_of(options, *scene), .every = options.every, .level = {},
                     .workers = options.threads};
  if (options.level >= 0) run.level = static_cast<std::uint32_t>(options.level);
  const CollideReport report = run_collide(scene, modes, run);
  fmt::print("{}: {} muscles, {} vertices, {} points every {:.0f} mm; {} frames at {:.0f} Hz, counted from frame {}\n\n",
             scene->name, report.asset->size(), report.asset->vertex_count, report.rest.points,
             mm(muscle::kSampleSpacing), run.frames, scene->step_hz, run.first);
  fmt::print("{}", to_table(report, run.first));
  if (options.pairs > 0) {
    std::vector<CollidePair> rest;
    for (const auto* list : {&report.rest.bones, &report.rest.muscles}) {
      for (const PairDepth& pair : *list) rest.push_back({pair, 0, 0.0f});
    }
    std::stable_sort(rest.begin(), rest.end(), [](const CollidePair& a, const CollidePair& b) {
      return a.deepest.depth > b.deepest.depth;
    });
    fmt::print("\nrest\n{}", pair_table(report, rest, options.pairs));
    for (const CollideRun& mode : report.runs) {
      fmt::print("\n{}\n{}", to_string(mode.mode), pair_table(report, mode.pairs, options.pairs));
    }
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
  command->add_option("--hz", options->hz, "Steps a second (the scene's)")->check(CLI::Range(1.0, 1000.0));
  command->add_option("--cycles", options->cycles, "Lengths of the animation (10)")->check(CLI::Range(0.01, 1e4));
  command->add_option("--every", options->every, "Measure one step in so many (1)")->check(CLI::Range(1, 1000000));
  command->add_option("--modes", options->modes, "Of: without, with, legacy (all that the character has)")
      ->delimiter(',')
      ->check(CLI::IsMember({"without", "with", "legacy"}));
  command->add_option("--level", options->level, "Level of detail (0, the finest)")->check(CLI::Range(0, 64));
  command->add_option("--pairs", options->pairs, "List so many of the worst pairs, of bones and of muscles (20)")
      ->expected(0, 1)
      ->default_str("20")
      ->check(CLI::Range(1, 10000));
  command->add_option("--csv", options->csv, "Write the figures of every measured step to this file");
  command->add_option("--threads", options->threads, "Workers (one for each core)")->check(CLI::Range(0, 256));
  command->callback([options, &chosen] { chosen = [options] { return collide(*options); }; });
}

}  // namespace fascicle::cook
