#include <algorithm>
#include <array>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <system_error>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/core.h>

#include "engine/animation/skeleton.hpp"
#include "engine/content/closest_name.hpp"
#include "modules/muscle/asset/build_muscle_asset.hpp"
#include "modules/muscle/asset/muscle_asset.hpp"
#include "modules/muscle/content/character_asset.hpp"
#include "modules/muscle/content/find_content.hpp"
#include "tools/fascicle_cook/commands.hpp"

namespace fascicle::cook {
namespace {

namespace fs = std::filesystem;

constexpr std::array<std::uint32_t, 3> kSubdivisions{0, 1, 2};
constexpr std::array<std::uint32_t, 5> kSectionVertices{6, 8, 10, 12, 36};

fs::path find_character(const std::string& name_or_path) {
  const fs::path given(name_or_path);
  std::error_code error;
  if (given.extension() == ".json" || fs::is_regular_file(given, error)) return given;
  return muscle::find_content_folder() / "characters" / given / (given.filename().string() + ".character.json");
}

// The characters that can be given by name.
std::vector<std::string> known_characters() {
  std::vector<std::string> names;
  std::error_code error;
  const fs::path folder = muscle::find_content_folder() / "characters";
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error)) {
    const std::string name = entry->path().filename().string();
    if (fs::is_regular_file(find_character(name), error)) names.push_back(name);
  }
  std::ranges::sort(names);
  return names;
}

int print_counts(const std::string& name) {
  const fs::path file = find_character(name);
  if (std::error_code error; !fs::exists(file, error)) {
    const std::vector<std::string> known = known_characters();
    fmt::print(stderr, "{}: no such character, nor such a file; {}\n", name,
               suggest_name(name, std::span<const std::string>(known), "characters"));
    return kErrors;
  }
  const auto character = muscle::load_character(file);
  for (const Diagnostic& error : character.diagnostics().errors) fmt::print(stderr, "{}\n", to_string(error));
  if (!character) return kErrors;
  std::vector<muscle::MuscleDescription> descriptions = (*character)->descriptions;
  std::size_t via = 0;
  for (const muscle::MuscleDescription& description : descriptions) {
    for (const muscle::AttachmentDescription& point : description.attachments) via += point.counts ? 1 : 0;
    via -= 2;
  }
  fmt::print("{}: {} muscles, {} via points (extras and tendon sections left out)\n\n", (*character)->name,
             descriptions.size(), via);
  fmt::print("vertices by |C|          ");
  for (const std::uint32_t count : kSectionVertices) fmt::print("{:>9}", count);
  fmt::print("\n");
  for (const std::uint32_t subdivision : kSubdivisions) {
    std::string row;
    std::uint32_t sections = 0;
    for (const std::uint32_t count : kSectionVertices) {
      for (muscle::MuscleDescription& description : descriptions) {
        description.section_vertices = count;
        description.longitudinal_subdivision = subdivision;
      }
      const auto asset = muscle::build_muscle_asset(descriptions, (*character)->skeleton->rest_world);
      if (!asset) {
        for (const Diagnostic& error : asset.diagnostics().errors) fmt::print(stderr, "{}\n", to_string(error));
        return kErrors;
      }
      const muscle::MuscleCounts counts = muscle::count_muscles(**asset);
      sections = counts.sections;
      row += fmt::format("{:>9}", counts.vertices);
    }
    fmt::print("{:<25}{}\n", fmt::format("LSS {} ({} sections)", subdivision, sections), row);
  }
  return kFine;
}

}  // namespace

void add_counts(CLI::App& program, Command& chosen) {
  auto name = std::make_shared<std::string>();
  CLI::App* command = program.add_subcommand(
      "counts", "Print how many sections and vertices a character's muscles have, by level of detail");
  command->add_option("CHARACTER", *name, "A character's name (walker) or its file")->required();
  command->callback([name, &chosen] { chosen = [name] { return print_counts(*name); }; });
}

}  // namespace fascicle::cook
