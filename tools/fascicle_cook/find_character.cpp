#include "tools/fascicle_cook/find_character.hpp"

#include <algorithm>
#include <span>
#include <system_error>
#include <vector>

#include <fmt/core.h>

#include "engine/content/closest_name.hpp"
#include "engine/content/length_unit.hpp"
#include "engine/content/mesh_reader.hpp"
#include "modules/muscle/content/find_content.hpp"

namespace fascicle::cook {
namespace {

namespace fs = std::filesystem;

fs::path file_in_content(const fs::path& name) {
  return muscle::find_content_folder() / "characters" / name / (name.filename().string() + ".character.json");
}

// The characters that can be given by name.
std::vector<std::string> known_characters() {
  std::vector<std::string> names;
  std::error_code error;
  const fs::path folder = muscle::find_content_folder() / "characters";
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error)) {
    const std::string name = entry->path().filename().string();
    if (fs::is_regular_file(file_in_content(name), error)) names.push_back(name);
  }
  std::ranges::sort(names);
  return names;
}

}  // namespace

Result<fs::path> find_character(const std::string& name_or_path) {
  const fs::path given(name_or_path);
  std::error_code error;
  const fs::path file =
      given.extension() == ".json" || fs::is_regular_file(given, error) ? given : file_in_content(given);
  if (fs::exists(file, error)) return file;
  const std::vector<std::string> known = known_characters();
  return Diagnostic{name_or_path, 0, 0, {}, "no such character, nor such a file",
                    suggest_name(name_or_path, std::span<const std::string>(known), "characters")};
}

std::optional<std::string> as_mesh_reference(const std::string& input) {
  constexpr std::string_view kData = "data:";
  const std::string path =
      input.starts_with(kData) ? (muscle::find_data_folder() / input.substr(kData.size())).string() : input;
  if (!is_mesh_file(split_mesh_reference(path).file)) return std::nullopt;
  return path;
}

std::vector<std::string> length_unit_names() {
  std::vector<std::string> names;
  for (const LengthUnit& unit : kLengthUnits) names.emplace_back(unit.name);
  return names;
}

void print_diagnostics(const Diagnostics& diagnostics) {
  for (const Diagnostic& error : diagnostics.errors) fmt::print(stderr, "{}\n", to_string(error));
  for (const Diagnostic& warning : diagnostics.warnings) fmt::print(stderr, "warning: {}\n", to_string(warning));
}

}  // namespace fascicle::cook
