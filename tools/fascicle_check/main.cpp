// fascicle-check: tells what is wrong with content files, by loading them exactly as the game does.
//
// Exit status: 0 all files are fine (warnings allowed), 1 a file has errors, 2 wrong usage.

#include <algorithm>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/core.h>

#include "engine/content/closest_name.hpp"
#include "engine/content/file_text.hpp"
#include "engine/content/limit_errors.hpp"
#include "modules/muscle/content/check_content.hpp"
#include "modules/muscle/content/find_content.hpp"
#include "engine/content/run_program.hpp"

namespace {

using namespace fascicle;
namespace fs = std::filesystem;

constexpr int kFine = 0, kErrors = 1, kUsage = 2;

struct Options {
  std::vector<std::string> files;
  std::string format = "text";
  std::string schema;
  std::string data_folder;
  bool migrate = false;
};

int print_schema(const std::string& kind) {
  const std::filesystem::path file =
      muscle::find_content_folder() / "schema" / fmt::format("{}.schema.json", kind);
  const Result<std::string> text = read_text_file(file);
  if (!text) {
    fmt::print(stderr, "{}", to_text(text.diagnostics()));
    return kErrors;
  }
  fmt::print("{}", *text);
  return kFine;
}

// The content files that are known by name, as a path that can be given to this program.
std::vector<std::string> known_files() {
  std::vector<std::string> files;
  std::error_code error;
  const fs::path content = muscle::find_content_folder();
  for (const char* kind : {"characters", "scenes"}) {
    for (fs::recursive_directory_iterator entry(content / kind, error), end; !error && entry != end;
         entry.increment(error)) {
      const std::string name = entry->path().filename().string();
      if (name.ends_with(".character.json") || name.ends_with(".scene.json")) files.push_back(entry->path().string());
    }
  }
  std::ranges::sort(files);
  return files;
}

// "did you mean FILE?" for a name without a file: the known file of its kind (of any, where it tells none) whose
// name is close to it; else the known names.
std::string suggest_file(const fs::path& missing) {
  const std::string given = missing.filename().string();
  const std::string stem = given.substr(0, given.find('.')), kind = given.substr(stem.size());
  std::vector<std::string> files, names, stems;
  for (const std::string& file : known_files()) {
    const std::string name = fs::path(file).filename().string();
    const std::size_t dot = name.find('.');
    if (!kind.empty() && name.substr(dot) != kind) continue;
    files.push_back(file);
    names.push_back(name);
    stems.push_back(name.substr(0, dot));
  }
  const std::string_view close = closest_name(stem, stems);
  std::string matches;
  for (std::size_t i = 0; !close.empty() && i < files.size(); ++i) {
    if (stems[i] == close) matches += fmt::format("{}'{}'", matches.empty() ? "" : " or ", files[i]);
  }
  if (!matches.empty()) return fmt::format("did you mean {}?", matches);
  return names.empty() ? "check the name" : suggest_name(given, std::span<const std::string>(names), "files");
}

Diagnostics check_file(const std::string& file, const Options& options) {
  std::error_code error;
  if (!fs::exists(file, error)) {
    return {.errors = {{.file = file, .path = {}, .cause = "no such file", .remedy = suggest_file(file)}},
            .warnings = {}};
  }
  Diagnostics found;
  if (options.migrate) found = muscle::migrate_content_file(file);
  if (found.ok()) found.append(muscle::check_content(file, muscle::LoadOptions{.data_folder = options.data_folder}));
  return found;
}

int check(const Options& options) {
  Diagnostics all;
  const bool as_text = options.format == "text";
  for (const std::string& file : options.files) {
    Diagnostics found = check_file(file, options);
    if (as_text) {
      const std::size_t errors = count_with_left_out(found.errors);
      for (const Diagnostic& error : found.errors) fmt::print("{}\n", to_string(error));
      for (const Diagnostic& warning : found.warnings) fmt::print("warning: {}\n", to_string(warning));
      fmt::print("{}: {}\n", file,
                 found.ok() ? "fine"
                            : fmt::format("{} error{}", errors, errors == 1 ? "" : "s"));
    }
    all.append(std::move(found));
  }
  if (!as_text) fmt::print("{}\n", to_json(all));
  return all.ok() ? kFine : kErrors;
}

int run(int argc, char** argv) {
  CLI::App app("Checks Fascicle's character and scene files, with every file that they name.", "fascicle-check");
  Options options;
  app.add_option("FILE", options.files, "NAME.character.json or NAME.scene.json");
  app.add_option("--format", options.format, "How to print what was found, to standard output: text or json")
      ->check(CLI::IsMember({"text", "json"}));
  app.add_option("--print-schema", options.schema, "Print the JSON schema of: character, collision, scene, joints")
      ->check(CLI::IsMember({"character", "collision", "scene", "joints"}));
  app.add_option("--data", options.data_folder, "The folder that data: stands for (else FASCICLE_DATA)");
  app.add_flag("--migrate", options.migrate,
               "Rewrite files of an older version in the current one, in place, then check them");
  app.footer("Exit status: 0 fine (warnings allowed), 1 errors, 2 wrong usage.");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? kFine : kUsage;
  }
  if (!options.schema.empty()) return print_schema(options.schema);
  if (options.files.empty()) {
    fmt::print(stderr, "no file given; try fascicle-check --help\n");
    return kUsage;
  }
  return check(options);
}

}  // namespace

int main(int argc, char** argv) {
  return fascicle::run_program("fascicle-check", [&] { return run(argc, argv); });
}
