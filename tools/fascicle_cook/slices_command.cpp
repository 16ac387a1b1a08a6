#include <algorithm>
#include <array>
#include <filesystem>
#include <memory>
#include <set>
#include <span>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/core.h>
#include <fmt/format.h>

#include "engine/animation/skeleton.hpp"
#include "engine/content/closest_name.hpp"
#include "engine/content/file_text.hpp"
#include "engine/content/mesh_reader.hpp"
#include "engine/content/length_unit.hpp"
#include "engine/geometry/clean_mesh.hpp"
#include "engine/geometry/slice_analysis.hpp"
#include "modules/muscle/content/character_asset.hpp"
#include "tools/fascicle_cook/commands.hpp"
#include "tools/fascicle_cook/find_character.hpp"
#include "tools/fascicle_cook/slices_plot.hpp"
#include "tools/fascicle_cook/slices_report.hpp"

namespace fascicle::cook {
namespace {

struct Options {
  std::vector<std::string> inputs;
  std::vector<double> fractions{0.25, 0.5, 0.75};
  std::string unit = "m";
  std::string csv, svg;
};

struct Analysis {
  std::vector<MeshSlice> slices;
  std::size_t meshes = 0;
  Diagnostics diagnostics;
};

Diagnostic say(const std::string& where, std::string cause, std::string remedy) {
  return {where, 0, 0, {}, std::move(cause), std::move(remedy)};
}

// `line`: from origin to insertion; empty: the mesh's principal axis.
void analyse(const TriangleMesh& source, const std::string& name, std::span<const glm::dvec3> line,
             std::span<const double> fractions, Analysis& analysis) {
  CleanMesh clean = clean_mesh(source);
  if (clean.mesh.indices.empty()) {
    analysis.diagnostics.errors.push_back(
        say(name, "the mesh has no triangles to slice", "give a surface of triangles"));
    return;
  }
  if (!clean.defects.sound()) {
    analysis.diagnostics.warnings.push_back(
        say(name, clean.defects.to_text(), "mend the mesh if its slices look wrong"));
  }
  clean.mesh.name = name;
  const auto stations = line.empty() ? place_stations(clean.mesh, fractions) : place_stations(line, fractions);
  analysis.meshes += 1;
  for (MeshSlice& slice : slice_at(clean.mesh, stations)) {
    if (slice.loops.empty()) {
      analysis.diagnostics.warnings.push_back(say(
          name, fmt::format("the plane at {:.3g} of the length misses the mesh", slice.fraction),
          line.empty() ? "slice elsewhere (--at)" : "slice elsewhere (--at), or move the action line to its mesh"));
    }
    analysis.slices.push_back(std::move(slice));
  }
}

// The remedy for a file that is not there.
std::string suggest_file(const std::filesystem::path& missing) {
  std::vector<std::string> names;
  std::error_code error;
  const std::filesystem::path folder = missing.has_parent_path() ? missing.parent_path() : ".";
  for (std::filesystem::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error)) {
    if (is_mesh_file(entry->path())) names.push_back(entry->path().filename().string());
  }
  if (names.empty()) return fmt::format("there is no mesh in {}", folder.string());
  std::ranges::sort(names);
  return suggest_name(missing.filename().string(), std::span<const std::string>(names), "meshes");
}

void analyse_file(const std::string& reference, float unit, std::span<const double> fractions, Analysis& analysis) {
  const std::filesystem::path file = split_mesh_reference(reference).file;
  if (std::error_code error; !std::filesystem::exists(file, error)) {
    analysis.diagnostics.errors.push_back(say(reference, "no such file", suggest_file(file)));
    return;
  }
  Result<TriangleMesh> mesh = read_mesh(reference);
  if (mesh) {
    for (glm::vec3& position : mesh->positions) position *= unit;
    const std::string name = split_mesh_reference(reference).name;
    analyse(*mesh, name.empty() ? file.stem().string() : name, {}, fractions, analysis);
  }
  analysis.diagnostics.append(std::move(mesh.diagnostics()));
}

// Each muscle's mesh across its action line; a mesh of several heads across the first one's.
void analyse_character(const std::string& name, std::span<const double> fractions, Analysis& analysis) {
  Result<std::filesystem::path> file = find_character(name);
  analysis.diagnostics.append(std::move(file.diagnostics()));
  if (!file) return;
  auto character = muscle::load_character(*file, {.fit = muscle::FitMode::kNone, .bone_fields = false});
  analysis.diagnostics.append(std::move(character.diagnostics()));
  if (!character) return;
  std::set<const TriangleMesh*> done;
  for (const muscle::MuscleDescription& description : (*character)->descriptions) {
    const auto mesh = (*character)->muscle_meshes.find(description.name);
    if (mesh == (*character)->muscle_meshes.end() || !done.insert(mesh->second.get()).second) continue;
    std::vector<glm::dvec3> line;
    for (const muscle::AttachmentDescription& point : description.attachments) {
      const glm::mat4& bone = (*character)->skeleton->rest_world[static_cast<std::size_t>(point.bone)];
      line.emplace_back(bone * glm::vec4(point.position, 1.0f));
    }
    analyse(*mesh->second, description.name, line, fractions, analysis);
  }
  if (done.empty()) {
    analysis.diagnostics.errors.push_back(
        say(name, "none of the character's muscles has a mesh", "name one that has, or a mesh file"));
  }
}

int slice(const Options& options) {
  const float unit = metres_of(options.unit).value_or(1.0f);
  Analysis analysis;
  for (const std::string& input : options.inputs) {
    if (const std::optional<std::string> mesh = as_mesh_reference(input)) {
      analyse_file(*mesh, unit, options.fractions, analysis);
    } else {
      analyse_character(input, options.fractions, analysis);
    }
  }
  if (!analysis.slices.empty()) {
    std::string title;
    constexpr std::size_t kMostNames = 4;
    for (std::size_t i = 0; i < std::min(options.inputs.size(), kMostNames); ++i) {
      title += (title.empty() ? "" : ", ") + std::filesystem::path(options.inputs[i]).stem().string();
    }
    if (options.inputs.size() > kMostNames) title += fmt::format(" and {} more", options.inputs.size() - kMostNames);
    if (!options.csv.empty()) {
      analysis.diagnostics.append(write_text_atomically(options.csv, slices_csv(analysis.slices)));
    } else {
      fmt::print("{}\n", slices_table(analysis.slices));
    }
    if (!options.svg.empty()) {
      analysis.diagnostics.append(
          write_text_atomically(options.svg, plot_slices("Slices of " + title, analysis.slices)));
    }
    fmt::print("{}", describe_slices(summarise_slices(analysis.slices), analysis.meshes));
  }
  print_diagnostics(analysis.diagnostics);
  return analysis.diagnostics.ok() ? kFine : kErrors;
}

}  // namespace

void add_slices(CLI::App& program, Command& chosen) {
  auto options = std::make_shared<Options>();
  CLI::App* command = program.add_subcommand(
      "slices", "Analyse the cross sections of muscle meshes: how round, convex or concave they are");
  command->add_option("INPUT", options->inputs,
                      "Characters, by name (walker) or file, whose muscles' meshes are sliced across their action "
                      "lines; or mesh files (.vtk .vtp .obj .ply .stl .glb#NAME), sliced across their principal axes")
      ->required();
  command->add_option("--at", options->fractions, "Where along the length, as fractions (0.25,0.5,0.75)")
      ->delimiter(',')
      ->check(CLI::Range(0.0, 1.0))
      ->check([](const std::string& text) { return text.find_first_of("nN") == std::string::npos ? "" : "not a number"; });
  command->add_option("--unit", options->unit, "The unit of mesh files' numbers (m)")->check(CLI::IsMember(length_unit_names()));
  command->add_option("--csv", options->csv, "Write the slices to this file, a loop a line, in place of the table");
  command->add_option("--svg", options->svg,
                      "Write a plot to this file: quotient against perimeter, and the outlines overlaid");
  command->callback([options, &chosen] { chosen = [options] { return slice(*options); }; });
}

}  // namespace fascicle::cook
