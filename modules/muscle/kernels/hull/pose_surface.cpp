#include "modules/muscle/kernels/hull/pose_surface.hpp"

#include <algorithm>
#include <cmath>

#include "modules/muscle/kernels/hull/hull_problem.hpp"
#include "modules/muscle/kernels/hull/hull_state.hpp"
#include "modules/muscle/kernels/hull/newton_step.hpp"
#include "modules/muscle/kernels/hull/push_out.hpp"
#include "modules/muscle/kernels/hull/refine_surface.hpp"
#include "modules/muscle/kernels/hull/sample_contacts.hpp"

namespace fascicle::muscle {
namespace {

constexpr float kSoftVolume = 1.0f;  // m^3/Pa: a muscle that gives way so much does not keep its volume

constexpr int kSettling = 3;         // volume and bones in turn: each undoes a little of the other

// The full mesh where the hull is: at rest moved by W U.
void expand(const HullProblem& problem, HullScratch& scratch) {
  const SurfaceAsset& asset = *problem.step.asset;
  const HullVector points = problem.step.points.first(asset.vertex_count);
  problem.kernels.multiply({.matrix = &problem.hull.weights, .in = scratch.state.moved, .out = points});
  for (std::uint32_t v = 0; v < asset.vertex_count; ++v) {
    points[v].x += asset.rest[v].x;
    points[v].y += asset.rest[v].y;
    points[v].z += asset.rest[v].z;
  }
}

// Vertices' rotations start from their clusters'.
void start_rotations(const HullProblem& problem, HullScratch& scratch) {
  for (std::uint32_t v = 0; v < problem.step.asset->vertex_count; ++v) {
    const std::uint32_t cluster = problem.hull.shape.cluster[v];
    for (std::size_t i = 0; i < 9; ++i) {
      scratch.vertex_rotations[v / kPanelRows].value[i][v % kPanelRows] =
          scratch.state.rotations[cluster / kPanelRows].value[i][cluster % kPanelRows];
    }
  }
}

}  // namespace

HullPose pose_surface(const SurfaceStep& step, const HullAsset& hull, const HullKernels& kernels,
                      const HullSettings& settings, std::span<const glm::vec3> line, HullScratch& scratch) {
  const HullProblem problem{step, hull, kernels, line, step.settings.volume_compliance < kSoftVolume};
  const SurfaceAsset& asset = *step.asset;
  const double size = static_cast<double>(asset.size);
  scratch.residuals.clear();
  scratch.refined.clear();
  std::ranges::fill(scratch.touches, BoneTouch{});
  place_bones(step, scratch.bones);
  const auto push = [&](HullRow before) {
    return push_out(step, scratch.bones, before, scratch.balls, scratch.near, scratch.touches);
  };

  HullPose pose;
  find_load(problem, scratch);
  start_state(problem, scratch);
  while (pose.iterations < settings.iterations && !pose.converged) {
    const double moved = newton_step(problem, scratch) / size;
    scratch.residuals.push_back(static_cast<float>(moved));
    ++pose.iterations;
    pose.converged = moved <= static_cast<double>(settings.tolerance);
    if (!std::isfinite(moved)) break;
  }
  expand(problem, scratch);
  attach_exactly(problem, scratch);
  if (settings.refinements > 0) {
    std::ranges::copy(step.points.first(asset.vertex_count), scratch.brought.begin());
    start_rotations(problem, scratch);
    for (std::uint32_t i = 0; i < settings.refinements; ++i) {
      scratch.refined.push_back(static_cast<float>(refine_once(problem, scratch) / size));
      std::ranges::copy(step.points.first(asset.vertex_count), scratch.before.begin());
      if (!push(scratch.before)) continue;
      for (std::uint32_t v = 0; v < asset.vertex_count; ++v) {
        if (place(step.points[v]) != place(scratch.before[v])) scratch.brought[v] = step.points[v];
      }
    }
  }
  pose.volume = restore_volume(problem, scratch);
  for (int i = 0; i < kSettling && push(step.points); ++i) pose.volume = restore_volume(problem, scratch);
  std::ranges::fill(step.velocity, SurfacePoint{});
  return pose;
}

}  // namespace fascicle::muscle
