#include <algorithm>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <system_error>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "engine/animation/clip.hpp"
#include "engine/animation/skeleton.hpp"
#include "engine/content/closest_name.hpp"
#include "engine/parallel/worker_arena.hpp"
#include "modules/muscle/content/edit_collision.hpp"
#include "modules/muscle/content/find_content.hpp"
#include "modules/muscle/content/save_collision.hpp"
#include "modules/muscle/content/scene_asset.hpp"
#include "tools/fascicle_cook/commands.hpp"
#include "tools/fascicle_cook/find_character.hpp"
#include "tools/fascicle_cook/find_constraints.hpp"
#include "tools/fascicle_cook/posed_muscles.hpp"

namespace fascicle::cook {
namespace {

namespace fs = std::filesystem;
using muscle::CharacterAsset;

struct Options {
  std::string character, clip, scene;
  std::uint32_t frames = 32;
  double near_mm = 5.0, every_mm = 40.0;
  int threads = 0;
  bool dry_run = false;
};

// The motion that a scene of the character's name plays on it: joint skeletons have no clips of their own.
std::shared_ptr<const Motion> find_motion(const fs::path& character, const std::string& scene_name) {
  const std::string stem = character.filename().string();
  const std::string name = scene_name.empty() ? stem.substr(0, stem.find('.')) : scene_name;
  const fs::path file = muscle::find_scene(name, muscle::find_content_folder());
  std::error_code error;
  if (!fs::exists(file, error)) return nullptr;
  const auto scene = muscle::load_scene(file, {.bone_fields = false});
  if (!scene) {
    print_diagnostics(scene.diagnostics());
    return nullptr;
  }
  for (const muscle::SceneCharacter& placed : (*scene)->characters) {
    const auto& files = placed.character->files;
    const bool same = !files.empty() && fs::equivalent(files.front(), character, error);
    if (same && placed.animation.motion) return placed.animation.motion;
  }
  return nullptr;
}

double mm(float metres) { return 1e3 * static_cast<double>(metres); }

std::string to_table(const CharacterAsset& character, const FoundConstraints& found) {
  struct Row {
    std::map<std::string, std::pair<int, float>> partners;  // tags, closest
    std::string bones;
  };
  std::map<std::uint32_t, Row> rows;
  for (const FoundTransversal& entry : found.transversals) {
    const std::string& partner = entry.tag.bone >= 0
                                     ? character.skeleton->names[static_cast<std::size_t>(entry.tag.bone)]
                                     : character.descriptions[entry.tag.second.muscle].name;
    const auto [at, fresh] =
        rows[entry.tag.first.muscle].partners.emplace(partner, std::pair(0, entry.distance));
    ++at->second.first;
    at->second.second = std::min(at->second.second, entry.distance);
  }
  for (const FoundStayOut& entry : found.stay_out) {
    std::string& text = rows[entry.tag.muscle].bones;
    for (std::size_t i = 0; i < entry.tag.bones.size(); ++i) {
      text += fmt::format("{}{} {:.1f}", text.empty() ? "" : ", ",
                          character.skeleton->names[static_cast<std::size_t>(entry.tag.bones[i])],
                          mm(entry.distances[i]));
    }
  }
  std::string text = fmt::format("{:<28}{}\n", "muscle", "partner, tags, closest mm; bones, closest mm");
  for (const auto& [m, row] : rows) {
    std::string name = character.descriptions[m].name;
    for (const auto& [partner, tags] : row.partners) {
      text += fmt::format("{:<28}{:<28}{:>4}{:>8.1f}\n", name, partner, tags.first, mm(tags.second));
      name.clear();
    }
    if (!row.bones.empty()) text += fmt::format("{:<28}stays out of {}\n", name, row.bones);
  }
  return text;
}

bool check_clip(const CharacterAsset& character, const Options& options) {
  if (options.clip.empty()) return true;
  std::vector<std::string> names;
  for (const auto& clip : character.clips) names.push_back(clip->name);
  if (std::find(names.begin(), names.end(), options.clip) != names.end()) return true;
  print_diagnostics({.errors = {{options.character, 0, 0, {}, fmt::format("there is no clip '{}'", options.clip),
                                 suggest_name(options.clip, names, "clips")}}, .warnings = {}});
  return false;
}

int constrain(const Options& options) {
  const auto file = find_character(options.character);
  if (!file) {
    print_diagnostics(file.diagnostics());
    return kErrors;
  }
  const auto loaded = muscle::load_character(*file, {.bone_fields = false});
  print_diagnostics(loaded.diagnostics());
  if (!loaded) return kErrors;
  const CharacterAsset& character = **loaded;
  if (!character.muscles) {
    print_diagnostics({.errors = {{file->string(), 0, 0, {}, "the character has no muscles", "add some"}},
                       .warnings = {}});
    return kErrors;
  }
  if (!check_clip(character, options)) return kErrors;
  const auto motion = character.joints ? find_motion(*file, options.scene) : nullptr;
  const auto poses = pose_range(character, motion.get(), options.clip, options.frames);
  FoundConstraints found;
  parallel::WorkerArena workers(options.threads);
  workers.execute([&] {
    found = find_constraints(character, poses,
                             {.near = static_cast<float>(1e-3 * options.near_mm),
                              .every = static_cast<float>(1e-3 * options.every_mm)});
  });
  muscle::AutomaticEntries entries;
  const muscle::CollisionNames names{character.descriptions, *character.skeleton};
  std::size_t both_sides = 0, with_bones = 0;
  for (const FoundTransversal& entry : found.transversals) {
    entries.transversals.push_back(write_entry(entry.tag, names, entry.mirror));
    with_bones += entry.tag.bone >= 0 ? 1 : 0;
    both_sides += character.mirror.axis >= 0 && !entry.mirror ? 1 : 0;
  }
  for (const FoundStayOut& entry : found.stay_out) {
    entries.stay_out.push_back(write_entry(entry.tag, names, entry.mirror));
  }
  fmt::print("{}", to_table(character, found));
  fmt::print("\n{}: {} poses; {} pairs of muscles come within {:.3g} mm, {} pairs of sections face each other, {} lie "
             "too deep in each other; {} sections lie beside a bone\n{} transversals ({} with bones, {} of both "
             "sides), {} muscles that stay out of bones\n",
             character.name, poses.size(), found.close_pairs, options.near_mm, found.close_sections, found.buried,
             found.beside_bones, found.transversals.size(), with_bones, both_sides, found.stay_out.size());
  const auto saved = save_automatic(*file, entries, !options.dry_run);
  print_diagnostics(saved.diagnostics());
  if (!saved) return kErrors;
  const char* said = !saved->changed ? "is up to date" : options.dry_run ? "would change" : "written";
  fmt::print("{} {}\n", saved->file.string(), said);
  if (saved->named_anew && !options.dry_run) fmt::print("{} names it now\n", file->string());
  return kFine;
}

}  // namespace

void add_constrain(CLI::App& program, Command& chosen) {
  auto options = std::make_shared<Options>();
  CLI::App* command = program.add_subcommand(
      "constrain", "Find where a character's muscles come close to each other and to bones, at rest and over its "
                   "animation, and write tags into its collision file; an author's own entries stay as they are");
  command->add_option("CHARACTER", options->character, "A character's name (walker) or its file")->required();
  command->add_option("--clip", options->clip, "This clip only (all of them)");
  command->add_option("--scene", options->scene,
                      "The scene whose motion a joint skeleton plays (that of the character's name)");
  command->add_option("--frames", options->frames, "Poses of each clip or motion (32)")->check(CLI::Range(0, 10000));
  command->add_option("--near", options->near_mm, "How near is close, mm (5)")->check(CLI::Range(0.01, 1000.0));
  command->add_option("--every", options->every_mm, "Distance between the tags of a pair, mm (40)")
      ->check(CLI::Range(0.0, 10000.0));
  command->add_flag("--dry-run", options->dry_run, "Write nothing");
  command->add_option("--threads", options->threads, "Workers (one for each core)")->check(CLI::Range(0, 256));
  command->callback([options, &chosen] { chosen = [options] { return constrain(*options); }; });
}

}  // namespace fascicle::cook
