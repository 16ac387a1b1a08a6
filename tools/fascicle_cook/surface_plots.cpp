#include "tools/fascicle_cook/surface_plots.hpp"

#include <algorithm>
#include <array>

#include <fmt/format.h>

#include "tools/fascicle_cook/surface_poses.hpp"
#include "tools/fascicle_cook/svg_plot.hpp"

namespace fascicle::cook {
namespace {

constexpr const char* kBlue = "#2a6fbb";
constexpr const char* kOrange = "#d9661f";
constexpr const char* kGrey = "#777777";

std::vector<double> values_of(const SurfaceMuscleRun& muscle, double SurfaceStepFigures::* member) {
  std::vector<double> values;
  for (const SurfaceStepFigures& step : muscle.steps) values.push_back(step.*member);
  return values;
}

ChartLine line_of(const SurfaceMuscleRun& muscle, const char* name, const char* colour,
                  double SurfaceStepFigures::* member) {
  return {name, colour, 1.8, values_of(muscle, member)};
}

// Colours round the wheel, so that neighbouring fibres can be told from each other.
std::string fibre_colour(std::size_t fibre) {
  constexpr std::array kColours = {"#2a6fbb", "#d9661f", "#3a9a4b", "#8a5fb4",
                                   "#b8443f", "#5b7a99", "#c29a1d", "#4aa3a2"};
  return kColours[fibre % kColours.size()];
}

Chart fibre_chart(const SurfaceMuscleRun& muscle) {
  Chart chart{.y_label = "fibre length (mm)", .lines = {}, .band = {}, .least_range = 1.0};
  for (std::size_t f = 0; f < muscle.fibre_ratios.size(); ++f) {
    ChartLine line{"", fibre_colour(f), muscle.fibre_ratios.size() > 100 ? 0.4 : 1.0, {}};
    for (const double ratio : muscle.fibre_ratios[f]) line.values.push_back(ratio * muscle.fibre_rest[f]);
    chart.lines.push_back(std::move(line));
  }
  return chart;
}

constexpr std::size_t kResidualPoses = 6;  // from the least angle to the largest

constexpr std::size_t kTailIterations = 12;  // after some less single precision tells no more

// Of the hull's poses that were iterated further.
Chart tail_chart(const SurfaceMuscleRun& muscle) {
  Chart tail{.y_label = "hull, iterated further", .lines = {}, .band = {}, .least_range = 1.0, .logarithmic = true};
  for (const SurfaceRevisit& visit : muscle.revisits) {
    if (visit.how != Revisit::kIterated || visit.residuals.empty()) continue;
    const double angle = pose_angle(*muscle.asset, muscle.poses[visit.step - 1]);
    const std::size_t shown = std::min(kTailIterations, visit.residuals.size());
    tail.lines.push_back({fmt::format("{:.2f} rad", angle), fibre_colour(tail.lines.size()), 1.8,
                          {visit.residuals.begin(), visit.residuals.begin() + static_cast<std::ptrdiff_t>(shown)}});
  }
  return tail;
}

// Of the hull, of poses that were iterated further, and of the full mesh, where there are any.
std::vector<Chart> residual_charts(const SurfaceMuscleRun& muscle) {
  Chart hull{.y_label = "hull: largest move / size", .lines = {}, .band = {}, .least_range = 1.0, .logarithmic = true};
  Chart full{.y_label = "mesh: largest move / size", .lines = {}, .band = {}, .least_range = 1.0, .logarithmic = true};
  std::vector<std::vector<std::uint64_t>> poses = posed_steps(muscle);
  // At rest there is nothing to do.
  std::erase_if(poses, [&](const auto& steps) {
    const std::vector<float>& residuals = muscle.poses[steps.front() - 1].residuals;
    return residuals.empty() || !(residuals.front() > muscle.hull.tolerance);
  });
  const std::size_t shown = std::min(kResidualPoses, poses.size());
  std::size_t longest = 0;
  bool any_full = false;
  for (std::size_t i = 0; i < shown; ++i) {
    const std::size_t at = shown == 1 ? 0 : i * (poses.size() - 1) / (shown - 1);
    const SurfacePose& pose = muscle.poses[poses[at].front() - 1];
    const std::string name = fmt::format("{:.2f} rad", pose_angle(*muscle.asset, pose));
    const auto line = [&](const std::vector<float>& residuals) {
      return ChartLine{name, fibre_colour(i), 1.8, {residuals.begin(), residuals.end()}};
    };
    hull.lines.push_back(line(pose.residuals));
    full.lines.push_back(line(pose.refined));
    longest = std::max(longest, pose.residuals.size());
    any_full |= !pose.refined.empty();
  }
  hull.lines.push_back({"tolerance", kGrey, 1.0,
                        std::vector<double>(std::max<std::size_t>(longest, 2), static_cast<double>(muscle.hull.tolerance))});
  std::vector<Chart> charts = {std::move(hull)};
  if (Chart tail = tail_chart(muscle); !tail.lines.empty()) charts.push_back(std::move(tail));
  if (any_full) charts.push_back(std::move(full));
  return charts;
}

}  // namespace

std::vector<SurfacePlot> surface_plots(const SurfaceRun& run, const SurfaceMuscleRun& muscle) {
  using F = SurfaceStepFigures;
  const auto& s = muscle.settings;
  const std::string subtitle =
      fmt::format("{}; {} substeps of 1/{:g} s{}", run.scene, s.substeps,
                  static_cast<double>(run.step_hz) * s.substeps,
                  run.options.solver == SolverSwitch::kOn ? "" : "; solver off");
  std::vector<SurfacePlot> plots;
  const auto add = [&](const char* what, const std::string& title, const std::vector<Chart>& charts) {
    plots.push_back({what, draw_charts(muscle.asset->name + ": " + title, subtitle, charts)});
  };
  add("volume", "volume",
      {{.y_label = "volume / volume at rest", .lines = {line_of(muscle, "", kBlue, &F::volume_ratio)}, .band = {},
        .least_range = 0.02}});
  add("edges", "edge lengths",
      {{.y_label = "edge / edge at rest",
        .lines = {line_of(muscle, "mean", kBlue, &F::edge_mean), line_of(muscle, "median", kOrange, &F::edge_p50)},
        .band = ChartBand{"5 to 95 % of the edges", kBlue, values_of(muscle, &F::edge_p5),
                          values_of(muscle, &F::edge_p95)},
        .least_range = 0.02},
       {.y_label = "edge / edge at rest",
        .lines = {line_of(muscle, "largest", kOrange, &F::edge_max), line_of(muscle, "smallest", kGrey, &F::edge_min)},
        .band = {}, .least_range = 0.1}});
  add("dihedral", "dihedral angles",
      {{.y_label = "mean |angle - angle at rest| (rad)", .lines = {line_of(muscle, "", kBlue, &F::dihedral_mean)},
        .band = {}, .least_range = 0.01}});
  add("bones", "bones and places",
      {{.y_label = "mm",
        .lines = {line_of(muscle, "deepest in a bone", kBlue, &F::bone_depth_max),
                  line_of(muscle, "attachment error", kOrange, &F::attachment_error_max)},
        .band = {}, .least_range = 0.1},
       {.y_label = "mm", .lines = {line_of(muscle, "furthest vertex from its place at rest", kBlue,
                                           &F::rest_distance_max)},
        .band = {}, .least_range = 0.1}});
  if (!muscle.fibre_ratios.empty()) {
    add("fibres", fmt::format("{} fibres", muscle.fibre_ratios.size()), {fibre_chart(muscle)});
  }
  if (!posed_steps(muscle).empty()) {
    plots.push_back({"residuals", draw_charts(muscle.asset->name + ": how far iterations move it",
                                              fmt::format("{}; coarse hull of {} vertices", run.scene,
                                                          muscle.hull_vertices),
                                              residual_charts(muscle), "iteration")});
  }
  return plots;
}

}  // namespace fascicle::cook
