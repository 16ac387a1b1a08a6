// fascicle-check: tells what is wrong with content files, by loading them exactly as the game does.
//
// Exit status: 0 all files are fine (warnings allowed), 1 a file has errors, 2 wrong usage.

#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/core.h>

#include "engine/content/file_text.hpp"
#include "modules/muscle/content/check_content.hpp"
#include "modules/muscle/content/find_content.hpp"

namespace {

using namespace fascicle;

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

int check(const Options& options) {
  Diagnostics all;
  const bool as_text = options.format == "text";
  for (const std::string& file : options.files) {
    Diagnostics found = options.migrate
                            ? muscle::migrate_content_file(file)
                            : muscle::check_content(file, muscle::LoadOptions{.data_folder = options.data_folder});
    if (as_text) {
      for (const Diagnostic& error : found.errors) fmt::print("{}\n", to_string(error));
      for (const Diagnostic& warning : found.warnings) fmt::print("warning: {}\n", to_string(warning));
      fmt::print("{}: {}\n", file,
                 found.ok() ? "fine"
                            : fmt::format("{} error{}", found.errors.size(), found.errors.size() == 1 ? "" : "s"));
    }
    all.append(std::move(found));
  }
  if (!as_text) fmt::print("{}\n", to_json(all));
  return all.ok() ? kFine : kErrors;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Checks Fascicle's character and scene files, with every file that they name.", "fascicle-check");
  Options options;
  app.add_option("FILE", options.files, "NAME.character.json or NAME.scene.json");
  app.add_option("--format", options.format, "How to print what was found, to standard output: text or json")
      ->check(CLI::IsMember({"text", "json"}));
  app.add_option("--print-schema", options.schema, "Print the JSON schema of: character, scene, joints")
      ->check(CLI::IsMember({"character", "scene", "joints"}));
  app.add_option("--data", options.data_folder, "The folder that data: stands for (else FASCICLE_DATA)");
  app.add_flag("--migrate", options.migrate, "Rewrite files of an older version in the current one, in place");
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
