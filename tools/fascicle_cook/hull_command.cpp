#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "engine/content/closest_name.hpp"
#include "engine/content/file_text.hpp"
#include "modules/muscle/content/character_asset.hpp"
#include "modules/muscle/content/hull_store.hpp"
#include "modules/muscle/content/surface_hulls.hpp"
#include "tools/fascicle_cook/commands.hpp"
#include "tools/fascicle_cook/find_character.hpp"
#include "tools/fascicle_cook/hull_report.hpp"
#ifdef FASCICLE_COOK_DRAWS
#include "tools/fascicle_cook/draw_hulls.hpp"
#endif

namespace fascicle::cook {
namespace {

namespace fs = std::filesystem;
using muscle::SurfaceMuscleDescription;

struct Options {
  std::string character, only, picture, obj_folder;
  std::vector<std::uint32_t> vertices;  // empty: as the content says
  double error = -1.0;                  // mm; negative: likewise
  bool store = false;
};

void complain(const std::string& file, std::string cause, std::string remedy) {
  print_diagnostics({.errors = {{file, 0, 0, {}, std::move(cause), std::move(remedy)}}, .warnings = {}});
}

bool write_file(const fs::path& file, const std::string& text) {
  const Diagnostics written = write_text_atomically(file, text);
  print_diagnostics(written);
  if (written.ok()) fmt::print("wrote {}\n", file.string());
  return written.ok();
}

std::vector<muscle::HullTarget> targets_of(const Options& options, const SurfaceMuscleDescription& description) {
  muscle::HullTarget target = muscle::hull_target(description);
  if (options.error >= 0.0) target.error = static_cast<float>(0.001 * options.error);
  if (options.vertices.empty()) return {target};
  std::vector<muscle::HullTarget> targets;
  for (const std::uint32_t vertices : options.vertices) targets.push_back({vertices, target.error});
  return targets;
}

// The hulls that loading would make, by the muscles that may be posed by one.
bool store_hulls(const fs::path& file, std::span<const SurfaceMuscleDescription> muscles,
                 std::span<const MeasuredHull> hulls) {
  muscle::HullStore store;
  for (const SurfaceMuscleDescription& muscle : muscles) {
    if (!muscle::uses_hull(muscle)) continue;
    const auto made = std::ranges::find(hulls, muscle.name, &MeasuredHull::muscle);
    if (made == hulls.end()) continue;
    store[muscle.name] = {muscle::hull_inputs(muscle.mesh, muscle::hull_target(muscle)), made->hull};
  }
  if (store.empty()) {
    complain(file.string(), "no muscle may be posed by a coarse hull", "give one a level with \"solver\": \"coarse_hull\"");
    return false;
  }
  return write_file(muscle::hull_store_of(file), write_hull_store(store));
}

bool write_objs(const Options& options, std::span<const MeasuredHull> hulls) {
  bool fine = true;
  for (const MeasuredHull& one : hulls) {
    const std::string name = fmt::format("{}-{}.obj", one.muscle, one.hull.mesh.positions.size());
    fine &= write_file(fs::path(options.obj_folder) / name, to_obj(one));
  }
  return fine;
}

#ifdef FASCICLE_COOK_DRAWS
bool draw(const Options& options, std::span<const MeasuredHull> hulls) {
  constexpr int kHeight = 500;  // pixels of each
  std::vector<PicturedHull> pictured;
  for (const MeasuredHull& one : hulls) {
    pictured.push_back({one.fine, &one.hull.mesh,
                        fmt::format("{}: {} vertices, +{:.1f} % volume", one.muscle, one.hull.mesh.positions.size(),
                                    100.0 * one.hull.overhead())});
  }
  const std::size_t columns = options.vertices.empty() ? std::min<std::size_t>(4, hulls.size()) : options.vertices.size();
  const Diagnostics drawn = draw_hulls(pictured, columns, kHeight, options.picture);
  print_diagnostics(drawn);
  if (drawn.ok()) fmt::print("wrote {}\n", options.picture);
  return drawn.ok();
}
#endif

int hull(const Options& options) {
  const Result<fs::path> file = find_character(options.character);
  print_diagnostics(file.diagnostics());
  if (!file) return kErrors;
  const auto character = muscle::load_character(
      *file, {.fit = muscle::FitMode::kNone, .hulls = muscle::HullMode::kNone, .bone_fields = false});
  print_diagnostics(character.diagnostics());
  if (!character) return kErrors;
  const std::vector<SurfaceMuscleDescription>& muscles = (*character)->surface_descriptions;
  std::vector<std::string> names;
  for (const SurfaceMuscleDescription& muscle : muscles) names.push_back(muscle.name);
  if (names.empty()) {
    complain(file->string(), "it has no surface muscle", "name a character that has one, such as 'hip-hull'");
    return kErrors;
  }
  if (!options.only.empty() && std::ranges::find(names, options.only) == names.end()) {
    complain(file->string(), fmt::format("it has no surface muscle '{}'", options.only),
             suggest_name(options.only, std::span<const std::string>(names), "surface muscles"));
    return kErrors;
  }

  bool fine = true;
  std::vector<MeasuredHull> hulls;
  for (const SurfaceMuscleDescription& muscle : muscles) {
    if (!options.only.empty() && muscle.name != options.only) continue;
    for (const muscle::HullTarget& target : targets_of(options, muscle)) {
      auto measured = measure_hull(muscle.name, muscle.mesh, target);
      print_diagnostics(measured.diagnostics());
      fine &= measured.ok() && measured->sound();
      if (measured) hulls.push_back(std::move(*measured));
    }
  }
  fmt::print("{}", to_table(hulls));
  if (!options.obj_folder.empty()) fine &= write_objs(options, hulls);
#ifdef FASCICLE_COOK_DRAWS
  if (!options.picture.empty()) fine &= draw(options, hulls);
#endif
  if (options.store && !fine) {
    complain(muscle::hull_store_of(*file).string(), "the hulls are not stored", "mend what is said above");
  } else if (options.store) {
    fine = store_hulls(*file, muscles, hulls);
  }
  return fine ? kFine : kErrors;
}

}  // namespace

void add_hull(CLI::App& program, Command& chosen) {
  auto options = std::make_shared<Options>();
  CLI::App* command =
      program.add_subcommand("hull", "Make coarse hulls round a character's surface muscles, measure and store them");
  command->add_option("CHARACTER", options->character, "A character's name (hip-hull) or file")->required();
  CLI::Option* only = command->add_option("--muscle", options->only, "This surface muscle alone (all)");
  CLI::Option* vertices =
      command->add_option("--vertices", options->vertices, "Vertices of the hull, one or more (as the content says)")
          ->check(CLI::Range(4, 1000000));
  CLI::Option* error =
      command->add_option("--error", options->error, "Millimetres that no vertex goes beyond, 0: any (as the content says)")
          ->check(CLI::Range(0.0, 1000.0));
  command->add_flag("--store", options->store,
                    "Write the hulls that loading would make beside the character's file: NAME.hulls.json")
      ->excludes(only)
      ->excludes(vertices)
      ->excludes(error);
#ifdef FASCICLE_COOK_DRAWS
  command->add_option("--picture", options->picture, "Draw the hulls' edges over the meshes to this PNG");
#endif
  command->add_option("--obj", options->obj_folder, "Write the hulls into this folder: MUSCLE-VERTICES.obj");
  command->footer("Exit status 1, too, where a hull is not closed or leaves a part of its mesh outside.");
  command->callback([options, &chosen] { chosen = [options] { return hull(*options); }; });
}

}  // namespace fascicle::cook
