#include "tools/fascicle_cook/surface_pose_report.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include <fmt/format.h>

#include "tools/fascicle_cook/surface_poses.hpp"

namespace fascicle::cook {
namespace {

// What a pose is the nearest of, where there are more poses than fit a page.
constexpr double kShownEvery = 0.1;  // rad
constexpr std::size_t kMostShown = 15;

struct ShownPose {
  std::uint64_t step;
  double angle;
};

std::vector<ShownPose> shown_poses(const SurfaceMuscleRun& run) {
  std::vector<ShownPose> all, shown;
  for (const std::vector<std::uint64_t>& steps : posed_steps(run)) {
    all.push_back({steps.front(), pose_angle(*run.asset, run.poses[steps.front() - 1])});
  }
  if (all.size() <= kMostShown) return all;
  const double last = all.back().angle;
  for (double angle = 0.0; angle < last + 0.5 * kShownEvery; angle += kShownEvery) {
    const auto nearest = std::min_element(all.begin(), all.end(), [&](const ShownPose& one, const ShownPose& other) {
      return std::abs(one.angle - angle) < std::abs(other.angle - angle);
    });
    if (shown.empty() || shown.back().step != nearest->step) shown.push_back(*nearest);
  }
  return shown;
}

std::string figures_of(const SurfaceStepFigures& s, double ms) {
  return fmt::format("{:>9.5f}{:>8.4f}{:>8.4f}{:>8.3f}{:>7.0f}{:>9.2f}", s.volume_ratio, s.edge_mean, s.dihedral_mean,
                     s.bone_depth_max, s.turned, ms);
}

}  // namespace

std::string surface_pose_table(const SurfaceMuscleRun& run, const SurfaceMuscleRun* smooth) {
  const std::vector<ShownPose> shown = shown_poses(run);
  if (shown.empty()) return {};
  const std::vector<PosePair> pairs = smooth == nullptr ? std::vector<PosePair>{} : pair_poses(run, *smooth);
  const std::string heads = fmt::format("{:>9}{:>8}{:>8}{:>8}{:>7}{:>9}", "volume", "edges", "angles", "in bone",
                                        "turned", "ms");
  std::string text = fmt::format("{:<16}{}{:>6}", "by its hull", heads, "its.");
  if (smooth != nullptr) {
    text += fmt::format(" |{} |{:>8}{:>8}{:>9}", heads, "angles", "mean", "furthest");
  }
  text += fmt::format("\n{:>8}{:>8}{:>9}{:>8}{:>8}{:>8}{:>7}{:>9}{:>6}", "rad", "step", "", "mean", "rad", "mm", "", "all",
                      "");
  if (smooth != nullptr) {
    text += fmt::format(" |{:>9}{:>8}{:>8}{:>8}{:>7}{:>9} |{:>8}{:>17}", "dynamics", "mean", "rad", "mm", "", "step",
                        "ratio", "apart, % of size");
  }
  text += '\n';
  for (const ShownPose& pose : shown) {
    const SurfaceStepFigures& s = run.steps[pose.step - 1];
    text += fmt::format("{:>8.3f}{:>8}{}{:>6.0f}", pose.angle, pose.step, figures_of(s, s.pose_ms), s.iterations);
    const auto pair = std::find_if(pairs.begin(), pairs.end(), [&](const PosePair& p) { return p.step == pose.step; });
    if (pair != pairs.end()) {
      const SurfaceStepFigures& beside = smooth->steps[pair->beside - 1];
      text += fmt::format(" |{} |{:>8.3f}{:>8.3f}{:>9.3f}", figures_of(beside, beside.step_ms),
                          bend_ratio(run, *smooth, *pair), 100.0 * pair->shapes.mean, 100.0 * pair->shapes.largest);
    }
    text += '\n';
  }
  return text;
}

std::string surface_residual_table(const SurfaceMuscleRun& run) {
  std::string text;
  for (const ShownPose& pose : shown_poses(run)) {
    const SurfacePose& found = run.poses[pose.step - 1];
    text += fmt::format("{:>8.3f} rad:", pose.angle);
    for (const float residual : found.residuals) text += fmt::format(" {:.1e}", residual);
    if (!found.refined.empty()) text += " | full mesh:";
    for (const float residual : found.refined) text += fmt::format(" {:.1e}", residual);
    text += '\n';
  }
  return text.empty() ? text : "how far iterations moved a vertex, of the size\n" + text;
}

std::string surface_residual_csv(const SurfaceRun& run) {
  std::string text = "muscle,step,angle_rad,mesh,iteration,residual\n";
  for (const SurfaceMuscleRun& muscle : run.muscles) {
    for (std::size_t i = 0; i < muscle.poses.size(); ++i) {
      const SurfacePose& pose = muscle.poses[i];
      const double angle = pose_angle(*muscle.asset, pose);
      const auto add = [&](const char* mesh, const std::vector<float>& residuals) {
        for (std::size_t k = 0; k < residuals.size(); ++k) {
          text += fmt::format("{},{},{:.6g},{},{},{:.6g}\n", muscle.asset->name, i + 1, angle, mesh, k + 1, residuals[k]);
        }
      };
      add("hull", pose.residuals);
      add("full", pose.refined);
    }
  }
  return text;
}

}  // namespace fascicle::cook
