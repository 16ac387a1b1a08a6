#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "engine/content/file_text.hpp"
#include "modules/muscle/content/find_content.hpp"
#include "tools/fascicle_cook/commands.hpp"
#include "tools/fascicle_cook/find_character.hpp"
#include "tools/fascicle_cook/surface_beside.hpp"
#include "tools/fascicle_cook/surface_checks.hpp"
#include "tools/fascicle_cook/surface_picture.hpp"
#include "tools/fascicle_cook/surface_plots.hpp"
#include "tools/fascicle_cook/surface_pose_report.hpp"
#include "tools/fascicle_cook/surface_report.hpp"
#include "tools/fascicle_cook/surface_run.hpp"
#include "tools/fascicle_cook/surface_switches.hpp"

namespace fascicle::cook {
namespace {

namespace fs = std::filesystem;

struct Options {
  std::string scene, csv, plots, beside, picture, solver = "on";
  std::vector<std::string> without;
  std::uint64_t frames = 0;
  int threads = 1;
  bool halve = false;
};

SurfaceRunOptions run_options(const Options& options) {
  SurfaceRunOptions run{.frames = options.frames, .workers = options.threads};
  if (options.solver == "off") run.solver = SolverSwitch::kOff;
  if (options.solver == "frozen") run.solver = SolverSwitch::kFrozen;
  if (options.solver == "dynamic") run.forced = muscle::SurfaceSolver::kDynamic;
  if (options.solver == "coarse_hull") run.forced = muscle::SurfaceSolver::kCoarseHull;
  for (const std::string& part : options.without) {
    if (part == "edges") run.edges = false;
    if (part == "angles") run.angles = false;
    if (part == "volume") run.volume = false;
    if (part == "bones") run.bones = false;
    if (part == "direction") run.direction = false;
  }
  return run;
}

bool write(const fs::path& file, const std::string& text) {
  const Diagnostics written = write_text_atomically(file, text);
  print_diagnostics(written);
  return written.ok();
}

// The steps' figures, and, where muscles were posed by their hulls, iterations in a second file beside it.
bool write_tables(const SurfaceRun& run, const fs::path& file) {
  bool written = write(file, surface_csv(run));
  const bool any_hull = std::any_of(run.muscles.begin(), run.muscles.end(),
                                    [](const SurfaceMuscleRun& muscle) { return muscle.hull_vertices > 0; });
  if (!any_hull) return written;
  fs::path iterations = file;
  iterations.replace_filename(file.stem().string() + "-residuals.csv");
  return write(iterations, surface_residual_csv(run)) && written;
}

bool write_plots(const SurfaceRun& run, const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  bool written = true;
  for (const SurfaceMuscleRun& muscle : run.muscles) {
    for (const SurfacePlot& plot : surface_plots(run, muscle)) {
      written &= write(folder / fmt::format("{}-{}.svg", muscle.asset->name, plot.what), plot.svg);
    }
  }
  return written;
}

// Runs as far as the flexion once more, with half the substep, and prints how much of the shape hung on it.
void print_halved(const std::shared_ptr<const muscle::SceneAsset>& scene, const SurfaceRun& run) {
  SurfaceRunOptions options = run.options;
  options.substeps_times = 2;
  options.frames = kFlexedStep;
  const SurfaceRun halved = run_surfaces(scene, options);
  for (std::size_t m = 0; m < run.muscles.size(); ++m) {
    if (run.muscles[m].flexed.empty()) continue;
    const ShapeDifference d = compare_shapes(*run.muscles[m].asset, run.muscles[m].flexed,
                                             halved.muscles[m].flexed);
    fmt::print("{}: with half the substep vertices are at step {} at most {:.3f} % of the muscle's size elsewhere "
               "({:.3f} % in the mean)\n",
               run.muscles[m].asset->name, kFlexedStep, 100.0 * d.largest, 100.0 * d.mean);
  }
}

// The same muscles by dynamics, through the motion that was asked for.
struct Beside {
  std::shared_ptr<const muscle::SceneAsset> scene;  // null: none was
  SurfaceRun run;
};

Result<Beside> run_beside(const muscle::SceneAsset& scene, const Options& options) {
  if (options.beside.empty()) return Beside{};
  const auto changed = scene_beside(scene, options.beside);
  if (!changed) return changed.diagnostics();
  SurfaceRunOptions run;
  run.frames = steps_to_peak(**changed);
  run.workers = options.threads;
  run.forced = muscle::SurfaceSolver::kDynamic;
  run.keep_poses = true;
  return Beside{*changed, run_surfaces(*changed, run)};
}

// Poses of the first muscle that its hull posed.
bool write_picture(const std::shared_ptr<const muscle::SceneAsset>& scene, const SurfaceRun& run, const Beside& beside,
                   const fs::path& file) {
  BesidePicture picture;
  picture.scene = scene;
  picture.beside = beside.scene;
  picture.options = run.options;
  picture.beside_options = beside.run.options;
  for (std::size_t m = 0; m < run.muscles.size() && picture.pairs.empty(); ++m) {
    picture.pairs = spread_pairs(pair_poses(run.muscles[m], beside.run.muscles[m]));
  }
  const Diagnostics drawn = draw_beside(picture, file);
  print_diagnostics(drawn);
  return drawn.ok();
}

// Figures and checks of one muscle; whether all have passed.
bool print_muscle(const SurfaceRun& run, const SurfaceMuscleRun& muscle, const SurfaceMuscleRun* smooth) {
  const std::vector<SurfaceCheck> checks = check_surface(run.scene, muscle, smooth);
  fmt::print("{}\n{}\n", surface_configuration(run, muscle), surface_table(muscle));
  const std::string poses = surface_pose_table(muscle, smooth);
  if (!poses.empty()) fmt::print("{}\n{}\n", poses, surface_residual_table(muscle));
  fmt::print("{}\n", surface_checks_table(checks));
  return all_passed(checks);
}

int surface(const Options& options) {
  const auto loaded = muscle::load_scene(muscle::find_scene(options.scene, muscle::find_content_folder()));
  print_diagnostics(loaded.diagnostics());
  if (!loaded) return kErrors;
  const auto scene = without_parts(*loaded, run_options(options));
  print_diagnostics(scene.diagnostics());
  if (!scene) return kErrors;
  const auto beside = run_beside(**scene, options);
  print_diagnostics(beside.diagnostics());
  if (!beside) return kErrors;
  const SurfaceRun run = run_surfaces(*scene, run_options(options));
  if (run.muscles.empty()) {
    print_diagnostics({.errors = {{options.scene, 0, 0, {}, "no character of the scene has a surface muscle",
                                   "name a scene that has one, such as 'hip-gluteus'"}},
                       .warnings = {}});
    return kErrors;
  }
  bool passed = true;
  for (std::size_t m = 0; m < run.muscles.size(); ++m) {
    const SurfaceMuscleRun* smooth = m < beside->run.muscles.size() ? &beside->run.muscles[m] : nullptr;
    passed &= print_muscle(run, run.muscles[m], smooth);
  }
  if (options.halve) print_halved(*scene, run);
  bool written = true;
  if (!options.csv.empty()) written &= write_tables(run, options.csv);
  if (!options.plots.empty()) written &= write_plots(run, options.plots);
  if (!options.picture.empty()) written &= write_picture(*scene, run, *beside, options.picture);
  return passed && written ? kFine : kErrors;
}

}  // namespace

void add_surface(CLI::App& program, Command& chosen) {
  auto options = std::make_shared<Options>();
  CLI::App* command = program.add_subcommand(
      "surface", "Play a scene and measure its surface muscles: volume, edges, angles, fibres, depth in bones");
  command->add_option("SCENE", options->scene, "A scene's name or file")->required();
  command->add_option("--frames", options->frames, "Steps (the scene's)")->check(CLI::Range(1, 1000000));
  command->add_option("--csv", options->csv, "Write the figures of every step to this file; those of the coarse hull's\n"
                  "iterations to NAME-residuals.csv beside it");
  command->add_option("--plots", options->plots, "Write plots over the steps as SVG to this folder");
  command->add_option("--solver", options->solver,
                      "off: muscles are only carried by their bones; frozen: they stay as they are at rest;\n"
                      "dynamic, coarse_hull: of muscles that can have both, this one")
      ->check(CLI::IsMember({"on", "off", "frozen", "dynamic", "coarse_hull"}));
  command->add_option("--without", options->without, "Switch parts of the solver off: edges, angles, volume, bones, direction")
      ->delimiter(',')
      ->check(CLI::IsMember({"edges", "angles", "volume", "bones", "direction"}));
  CLI::Option* beside = command->add_option("--beside", options->beside,
                      "Compare poses with dynamics, played through this motion (hip-flexion, or a file): on the way to\n"
                      "its largest angle, which they reach smoothly");
  command->add_option("--picture", options->picture, "Write a PNG of some poses by both solvers, from three sides")
      ->needs(beside);
  command->add_flag("--halve", options->halve, "Compare the shape at step 100 with that of half the substep");
  command->add_option("--threads", options->threads, "Workers (1; 0: one for each core)")->check(CLI::Range(0, 256));
  command->footer("Exit status 1, too, where a check fails.");
  command->callback([options, &chosen] { chosen = [options] { return surface(*options); }; });
}

}  // namespace fascicle::cook
