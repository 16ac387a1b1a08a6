#include <algorithm>
#include <cctype>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <system_error>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/core.h>

#include "engine/content/closest_name.hpp"
#include "engine/content/file_text.hpp"
#include "engine/content/length_unit.hpp"
#include "modules/muscle/content/character_asset.hpp"
#include "tools/fascicle_cook/commands.hpp"
#ifdef FASCICLE_COOK_DRAWS
#include "tools/fascicle_cook/draw_fit.hpp"
#endif
#include "tools/fascicle_cook/find_character.hpp"
#include "tools/fascicle_cook/fit_report.hpp"
#include "tools/fascicle_cook/inside_table.hpp"
#include "tools/fascicle_cook/level_sweep.hpp"
#include "tools/fascicle_cook/mesh_character.hpp"

namespace fascicle::cook {
namespace {

namespace fs = std::filesystem;
using muscle::CharacterAsset;

struct Options {
  std::string source;
  bool table = false, levels = false, sections = false, dry_run = false;
  std::string only, report, levels_csv, picture, unit = "m";
  std::optional<std::uint32_t> section_vertices, longitudinal_subdivision;
  std::uint32_t supersampling = 3;
};

// Writes a file that was asked for; false where that failed, which has been said.
bool write_file(const std::string& file, const std::string& text) {
  const Diagnostics written = write_text_atomically(file, text);
  print_diagnostics(written);
  if (written.ok()) fmt::print("wrote {}\n", file);
  return written.ok();
}

// What is fitted, and where its fits are to be stored (a character's).
struct Source {
  std::shared_ptr<const CharacterAsset> character;
  fs::path store;
};

std::optional<Source> load(const Options& options) {
  if (const std::optional<std::string> mesh = as_mesh_reference(options.source)) {
    const auto made = make_mesh_character(*mesh, {.unit = metres_of(options.unit).value_or(1.0f),
                                                  .section_vertices = options.section_vertices.value_or(36),
                                                  .longitudinal_subdivision = options.longitudinal_subdivision.value_or(3),
                                                  .supersampling = options.supersampling});
    print_diagnostics(made.diagnostics());
    return made ? std::optional(Source{*made, {}}) : std::nullopt;
  }
  const auto file = find_character(options.source);
  if (!file) {
    print_diagnostics(file.diagnostics());
    return std::nullopt;
  }
  muscle::LoadOptions load_options;
  load_options.fit = options.table ? muscle::FitMode::kNone : muscle::FitMode::kFresh;
  load_options.bone_fields = false;
  load_options.section_vertices = options.section_vertices;
  load_options.longitudinal_subdivision = options.longitudinal_subdivision;
  const auto character = muscle::load_character(*file, load_options);
  print_diagnostics(character.diagnostics());
  if (!character) return std::nullopt;
  if ((*character)->muscle_meshes.empty()) {
    print_diagnostics({.errors = {{file->string(), 0, 0, {}, "no muscle has a mesh to be fitted to",
                                   "give muscles a \"mesh\""}}, .warnings = {}});
    return std::nullopt;
  }
  return Source{*character, muscle::fit_store_of(*file)};
}

#ifdef FASCICLE_COOK_DRAWS
bool draw(const FitReport& report, const std::string& png) {
  FitPicture picture;
  picture.title = report.character->name;
  for (const std::size_t i : report.muscles) {
    const auto mesh = report.character->muscle_meshes.find(report.character->descriptions[i].name);
    picture.muscles.push_back({.asset = report.character->muscles.get(),
                               .muscle = static_cast<std::uint32_t>(i),
                               .mesh = mesh == report.character->muscle_meshes.end() ? nullptr : mesh->second.get(),
                               .sections = report.character->fits[i].levels.front().fitted.sections});
  }
  const Diagnostics drawn = draw_fit(picture, png);
  print_diagnostics(drawn);
  if (drawn.ok()) fmt::print("wrote {}\n", png);
  return drawn.ok();
}
#endif

// Stored fits are of the levels that the content asks for, and no others.
bool store_fits(const Options& options, const Source& source) {
  if (source.store.empty() || options.dry_run || options.section_vertices || options.longitudinal_subdivision) return true;
  muscle::FitStore store;
  for (std::size_t i = 0; i < source.character->descriptions.size(); ++i) {
    const std::string& name = source.character->descriptions[i].name;
    if (source.character->muscle_meshes.contains(name)) store.emplace(name, source.character->fits[i]);
  }
  return write_file(source.store.string(), write_fit_store(store));
}

int fit(const Options& options) {
  const std::optional<Source> source = load(options);
  if (!source) return kErrors;
  const CharacterAsset& character = *source->character;
  if (options.table) {
    const auto table = make_inside_table(character);
    print_diagnostics(table.diagnostics());
    if (!table) return kErrors;
    fmt::print("{}", *table);
    return kFine;
  }
  bool sound = true;
  if (options.levels || !options.levels_csv.empty()) {
    const std::vector<SweptLevel> levels = sweep_levels(character);
    if (options.levels) fmt::print("{}", to_table(levels));
    if (!options.levels_csv.empty()) sound = write_file(options.levels_csv, to_csv(levels, character));
    return sound ? kFine : kErrors;
  }
  const FitReport report = make_fit_report(character, options.only);
  if (report.muscles.empty()) {
    std::vector<std::string> names;
    for (const auto& [name, mesh] : character.muscle_meshes) names.push_back(name);
    print_diagnostics({.errors = {{options.only, 0, 0, {}, "no such muscle with a mesh",
                                   suggest_name(options.only, names, "muscles")}}, .warnings = {}});
    return kErrors;
  }
  fmt::print("{}", to_table(report));
  if (options.sections) fmt::print("{}", to_section_table(report));
  if (!options.report.empty()) sound = write_file(options.report, to_json(report)) && sound;
#ifdef FASCICLE_COOK_DRAWS
  if (!options.picture.empty()) sound = draw(report, options.picture) && sound;
#endif
  sound = store_fits(options, *source) && sound;
  return sound ? kFine : kErrors;
}

}  // namespace

void add_fit(CLI::App& program, Command& chosen) {
  auto options = std::make_shared<Options>();
  CLI::App* command = program.add_subcommand(
      "fit", "Fit a character's muscles to their meshes and store the result beside its file; or try one mesh");
  command->add_option("SOURCE", options->source, "A character's name (walker) or file, or a mesh file (with --unit)")
      ->required();
  command->add_option("--muscle", options->only, "Report this muscle only");
  command->add_flag("--sections", options->sections, "Print what became of each section");
  command->add_option("--report", options->report, "Write everything as JSON to this file");
#ifdef FASCICLE_COOK_DRAWS
  command->add_option("--picture", options->picture,
                      "Draw the fit to this PNG: sections coloured by outcome, the mesh translucent over them");
#endif
  command->add_flag("--levels", options->levels, "Compare |C| = 6..36 and LSS = 0..3 with the meshes, and store nothing");
  command->add_option("--levels-csv", options->levels_csv, "The same for each muscle, to this CSV file");
  command->add_flag("--table", options->table,
                    "Print how many centres the rays alone leave outside: CSS 1-6 by |C| 6, 8, 10, 12 at LSS 1 | LSS 2");
  command->add_flag("--dry-run", options->dry_run, "Store nothing");
  command->add_option("--section-vertices", options->section_vertices, "|C| of all muscles (then nothing is stored)")
      ->check([](const std::string& text) {
        const bool digits = !text.empty() && std::ranges::all_of(text, [](unsigned char c) { return std::isdigit(c) != 0; });
        const unsigned long value = digits && text.size() < 4 ? std::stoul(text) : 0;
        return value >= 6 && value <= 256 && value % 2 == 0 ? "" : std::string("an even number from 6 to 256 is wanted");
      });
  command->add_option("--subdivision", options->longitudinal_subdivision, "LSS of all muscles (then nothing is stored)")
      ->check(CLI::Range(0, 6));
  command->add_option("--supersampling", options->supersampling, "CSS of a mesh file's fit (3)")->check(CLI::Range(1, 16));
  command->add_option("--unit", options->unit, "The unit of a mesh file (m)")
      ->check(CLI::IsMember(length_unit_names()));
  command->callback([options, &chosen] { chosen = [options] { return fit(*options); }; });
}

}  // namespace fascicle::cook
