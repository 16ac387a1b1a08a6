#include "tools/fascicle_cook/surface_report.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "modules/muscle/asset/surface/describe_settings.hpp"

namespace fascicle::cook {
namespace {

using Steps = std::vector<SurfaceStepFigures>;
using Member = double SurfaceStepFigures::*;

struct Figure {
  const char* column;  // of the CSV
  const char* row;     // of the table
  Member value;
  double best;         // the worst value is the one furthest from it
};

constexpr std::array kFigures = {
    Figure{"volume_ratio", "volume ratio", &SurfaceStepFigures::volume_ratio, 1.0},
    Figure{"edge_ratio_mean", "edge ratio, mean", &SurfaceStepFigures::edge_mean, 1.0},
    Figure{"edge_ratio_abs_mean", "mean |edge ratio - 1|", &SurfaceStepFigures::edge_abs_mean, 0.0},
    Figure{"edge_ratio_min", "edge ratio, smallest", &SurfaceStepFigures::edge_min, 1.0},
    Figure{"edge_ratio_p5", "edge ratio, 5 %", &SurfaceStepFigures::edge_p5, 1.0},
    Figure{"edge_ratio_p50", "edge ratio, 50 %", &SurfaceStepFigures::edge_p50, 1.0},
    Figure{"edge_ratio_p95", "edge ratio, 95 %", &SurfaceStepFigures::edge_p95, 1.0},
    Figure{"edge_ratio_max", "edge ratio, largest", &SurfaceStepFigures::edge_max, 1.0},
    Figure{"dihedral_change_mean_rad", "dihedral change, mean (rad)", &SurfaceStepFigures::dihedral_mean, 0.0},
    Figure{"dihedral_change_max_rad", "dihedral change, largest (rad)", &SurfaceStepFigures::dihedral_max, 0.0},
    Figure{"angle_max_rad", "dihedral angle, largest (rad)", &SurfaceStepFigures::angle_max, 0.0},
    Figure{"folded_edges", "edges folded to 170 degrees", &SurfaceStepFigures::folded, 0.0},
    Figure{"turned_edges", "edges turned inside out", &SurfaceStepFigures::turned, 0.0},
    Figure{"rest_distance_max_mm", "furthest vertex from rest (mm)", &SurfaceStepFigures::rest_distance_max, 0.0},
    Figure{"attachment_error_max_mm", "attachment error (mm)", &SurfaceStepFigures::attachment_error_max, 0.0},
    Figure{"bone_depth_max_mm", "deepest in a bone (mm)", &SurfaceStepFigures::bone_depth_max, 0.0},
    Figure{"bone_depth_beside_mm", "  beside attached vertices (mm)", &SurfaceStepFigures::bone_depth_beside, 0.0},
    Figure{"fallbacks", "fallbacks so far", &SurfaceStepFigures::fallbacks, 0.0},
    Figure{"step_ms", "time of the step (ms)", &SurfaceStepFigures::step_ms, 0.0},
};
// Of muscles with fibres, after the others.
constexpr std::array kFibreFigures = {
    Figure{"fibre_length_ratio_mean", "fibre length ratio, mean", &SurfaceStepFigures::fibre_mean, 1.0},
    Figure{"fibre_length_ratio_min", "fibre length ratio, smallest", &SurfaceStepFigures::fibre_min, 1.0},
    Figure{"fibre_length_ratio_max", "fibre length ratio, largest", &SurfaceStepFigures::fibre_max, 1.0},
    Figure{"fibre_points_outside", "fibre points outside", &SurfaceStepFigures::fibres_outside, 0.0},
    Figure{"fibre_outside_max_mm", "  furthest of them (mm)", &SurfaceStepFigures::fibre_furthest, 0.0},
};

// Of muscles with a coarse hull, last.
constexpr std::array kHullFigures = {
    Figure{"posed_by_hull", "posed by its hull (1)", &SurfaceStepFigures::posed, 1.0},
    Figure{"hull_iterations", "iterations", &SurfaceStepFigures::iterations, 0.0},
    Figure{"hull_converged", "converged (1)", &SurfaceStepFigures::converged, 1.0},
    Figure{"hull_residual", "last iteration's move, of the size", &SurfaceStepFigures::residual, 0.0},
    Figure{"pose_ms", "time of posing all muscles (ms)", &SurfaceStepFigures::pose_ms, 0.0},
};

template <class F>
void each_figure(bool fibres, bool hull, F&& f) {
  for (const Figure& figure : kFigures) f(figure);
  for (const Figure& figure : kFibreFigures) {
    if (fibres) f(figure);
  }
  for (const Figure& figure : kHullFigures) {
    if (hull) f(figure);
  }
}

// The step (from 0) at which the figure is worst; what is not finite is.
std::size_t worst_step(const Steps& steps, const Figure& figure) {
  std::size_t worst = 0;
  for (std::size_t i = 0; i < steps.size(); ++i) {
    const double value = steps[i].*figure.value;
    if (!std::isfinite(value)) return i;
    if (std::abs(value - figure.best) > std::abs(steps[worst].*figure.value - figure.best)) worst = i;
  }
  return worst;
}

// 1, 50, 100 .. 300, and the last.
std::vector<std::uint64_t> table_steps(std::uint64_t count) {
  std::vector<std::uint64_t> steps;
  for (const std::uint64_t step : {1, 50, 100, 150, 200, 250, 300}) {
    if (step <= count) steps.push_back(step);
  }
  if (!steps.empty() && steps.back() != count) steps.push_back(count);
  return steps;
}

}  // namespace

std::string surface_configuration(const SurfaceRun& run, const SurfaceMuscleRun& muscle) {
  const muscle::SurfaceAsset& asset = *muscle.asset;
  std::string text = fmt::format(
      "{} in {}: {} vertices, {} triangles, {} edges, volume {:.1f} cm3, mean edge {:.2f} mm\n", asset.name, run.scene,
      asset.vertex_count, asset.triangle_count(), asset.hinges.size(), 1e6 * asset.volume,
      1e3 * static_cast<double>(asset.mean_edge));
  for (std::size_t a = 0; a < asset.attachments.size(); ++a) {
    text += fmt::format("  {} on {}: {} vertices\n", asset.attachments[a].origin ? "origin" : "insertion",
                        muscle.bones[a], asset.attachments[a].count);
  }
  if (asset.attachments.empty()) text += "  attached to nothing\n";
  text += fmt::format("  {} steps of 1/{:g} s, {}\n", run.options.frames, run.step_hz, to_text(muscle.settings));
  text += fmt::format("  {} bones to collide with, {} fibres; simd {}, {} worker{}\n", asset.bones.size(),
                      muscle.fibre_rest.size(), run.simd, run.options.workers, run.options.workers == 1 ? "" : "s");
  if (muscle.hull_vertices > 0) {
    text += fmt::format("  coarse hull: {} vertices; at most {} iterations until one moves less than {:g} of the size\n",
                        muscle.hull_vertices, muscle.hull.iterations, muscle.hull.tolerance);
  }
  const SurfaceRunOptions& o = run.options;
  if (o.solver != SolverSwitch::kOn) {
    text += o.solver == SolverSwitch::kOff ? "  SOLVER OFF: carried by its bones only\n"
                                            : "  FROZEN: it stays as it is at rest\n";
  } else if (!o.edges || !o.angles || !o.volume || !o.bones || !o.direction) {
    text += fmt::format("  WITHOUT:{}{}{}{}{}\n", o.edges ? "" : " edges", o.angles ? "" : " angles",
                        o.volume ? "" : " volume", o.bones ? "" : " bones", o.direction ? "" : " direction");
  }
  return text;
}

std::string surface_table(const SurfaceMuscleRun& muscle) {
  const std::vector<std::uint64_t> shown = table_steps(muscle.steps.size());
  std::string text = fmt::format("{:<34}", "step");
  for (const std::uint64_t step : shown) text += fmt::format("{:>10}", step);
  text += fmt::format("{:>11}  at step\n", "worst");
  each_figure(!muscle.fibre_rest.empty(), muscle.hull_vertices > 0, [&](const Figure& figure) {
    text += fmt::format("{:<34}", figure.row);
    for (const std::uint64_t step : shown) text += fmt::format("{:>10.4f}", muscle.steps[step - 1].*figure.value);
    if (!muscle.steps.empty()) {
      const std::size_t worst = worst_step(muscle.steps, figure);
      text += fmt::format("{:>11.4f}  {}", muscle.steps[worst].*figure.value, worst + 1);
    }
    text += '\n';
  });
  return text;
}

std::string surface_checks_table(const std::vector<SurfaceCheck>& checks) {
  std::string text;
  for (const SurfaceCheck& check : checks) {
    text += fmt::format("{:<5} {:<50} {:>12}  ", check.passed ? "PASS" : check.reached ? "FAIL" : "-", check.what,
                        check.limit);
    text += check.reached ? fmt::format("{:.5g}", check.found) : std::string("the run is shorter");
    if (check.reached && check.step > 0) text += fmt::format(" (step {})", check.step);
    if (!check.why.empty()) text += ", " + check.why;
    text += '\n';
  }
  return text;
}

std::string surface_csv(const SurfaceRun& run) {
  std::string text = "muscle,step";
  each_figure(true, true, [&](const Figure& figure) { text += fmt::format(",{}", figure.column); });
  text += '\n';
  for (const SurfaceMuscleRun& muscle : run.muscles) {
    for (std::size_t i = 0; i < muscle.steps.size(); ++i) {
      text += fmt::format("{},{}", muscle.asset->name, i + 1);
      each_figure(true, true, [&](const Figure& figure) { text += fmt::format(",{:.9g}", muscle.steps[i].*figure.value); });
      text += '\n';
    }
  }
  return text;
}

}  // namespace fascicle::cook
