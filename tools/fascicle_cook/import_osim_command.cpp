#include <filesystem>
#include <memory>
#include <string>

#include <CLI/CLI.hpp>
#include <fmt/core.h>

#include "engine/content/file_text.hpp"
#include "modules/muscle/content/find_content.hpp"
#include "modules/muscle/import/import_osim.hpp"
#include "modules/muscle/import/osim_reader.hpp"
#include "tools/fascicle_cook/commands.hpp"
#include "tools/fascicle_cook/find_character.hpp"

namespace fascicle::cook {
namespace {

namespace fs = std::filesystem;

struct Options {
  std::string model;
  std::string out;
  std::string geometry;
  muscle::ImportOptions import;
};

// How a character file in `from` names files in `folder`: by data: where they are in the data folder, else relatively.
std::string prefix_of(const fs::path& folder, const fs::path& from) {
  std::error_code error;
  const fs::path target = fs::weakly_canonical(folder, error);
  const fs::path data = muscle::find_data_folder();
  if (!data.empty()) {
    const fs::path inside = target.lexically_relative(fs::weakly_canonical(data, error));
    if (!inside.empty() && *inside.begin() != "..") return "data:" + inside.generic_string() + "/";
  }
  const fs::path relative = target.lexically_relative(fs::weakly_canonical(from, error));
  return (relative.empty() ? target : relative).generic_string() + "/";
}

int import_osim(Options options) {
  const fs::path model_file(options.model);
  Result<muscle::OsimModel> model = muscle::read_osim(model_file);
  print_diagnostics(model.diagnostics());
  if (!model) return kErrors;

  const std::string stem = model_file.stem().string();
  const fs::path out = options.out.empty() ? fs::path(stem + ".character.json") : fs::path(options.out);
  if (options.import.name.empty()) options.import.name = stem;
  options.import.geometry_folder =
      options.geometry.empty() ? model_file.parent_path() / "Geometry" : fs::path(options.geometry);
  options.import.geometry_prefix = prefix_of(options.import.geometry_folder, fs::absolute(out).parent_path());
  const Result<std::string> text = muscle::import_character(*model, options.import);
  print_diagnostics(text.diagnostics());
  if (!text) return kErrors;
  const Diagnostics written = write_text_atomically(out, *text);
  print_diagnostics(written);
  if (!written.ok()) return kErrors;
  fmt::print("{}: {} bodies, {} coordinates, {} bone meshes, {} muscles\n", out.string(),
             model->joints.skeleton->size() - 1, model->joints.coordinates.size(), model->geometry.size(),
             model->muscles.size());
  return kFine;
}

}  // namespace

void add_import_osim(CLI::App& program, Command& chosen) {
  auto options = std::make_shared<Options>();
  CLI::App* command = program.add_subcommand("import-osim", "Make a character file from an OpenSim model (version 4)");
  command->add_option("MODEL", options->model, "The model, .osim")->required();
  command->add_option("--out", options->out, "The character file to write (MODEL's name with .character.json, here)");
  command->add_option("--geometry", options->geometry, "The folder of the model's bone meshes (Geometry beside MODEL)");
  command->add_option("--name", options->import.name, "The character's name (MODEL's)");
  command->add_option("--source", options->import.source, "Where the model is from (its name, file and credits)");
  command->add_option("--licence", options->import.licence, "The model's licence (a CC BY that its credits name)");
  command->add_option("--specific-tension", options->import.specific_tension,
                      "Force a cross section that gives the muscles their thickness, N/m^2 (610000)")
      ->check(CLI::Range(1e4, 1e7));
  command->callback([options, &chosen] { chosen = [options] { return import_osim(*options); }; });
}

}  // namespace fascicle::cook
