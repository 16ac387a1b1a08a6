#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/core.h>

#include "engine/animation/skeleton.hpp"
#include "modules/muscle/asset/build_muscle_asset.hpp"
#include "modules/muscle/asset/muscle_asset.hpp"
#include "modules/muscle/content/character_asset.hpp"
#include "tools/fascicle_cook/commands.hpp"
#include "tools/fascicle_cook/find_character.hpp"

namespace fascicle::cook {
namespace {

constexpr std::array<std::uint32_t, 3> kSubdivisions{0, 1, 2};
constexpr std::array<std::uint32_t, 5> kSectionVertices{6, 8, 10, 12, 36};

int print_counts(const std::string& name) {
  const auto file = find_character(name);
  if (!file) {
    print_diagnostics(file.diagnostics());
    return kErrors;
  }
  const auto character = muscle::load_character(*file, {.bone_fields = false});
  print_diagnostics(character.diagnostics());
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
        print_diagnostics(asset.diagnostics());
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
