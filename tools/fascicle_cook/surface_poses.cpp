#include "tools/fascicle_cook/surface_poses.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <glm/geometric.hpp>

namespace fascicle::cook {
namespace {

void add(double difference, std::uint64_t step, Repeats& repeats) {
  ++repeats.count;
  if (std::isnan(repeats.largest) || (repeats.step != 0 && difference <= repeats.largest)) return;
  repeats.largest = difference;
  repeats.step = step;
}

}  // namespace

double poses_apart(const SurfacePose& one, const SurfacePose& other) {
  if (one.bones.size() != other.bones.size()) return std::numeric_limits<double>::infinity();
  double apart = 0.0;
  for (std::size_t b = 0; b < one.bones.size(); ++b) {
    for (int i = 0; i < 16; ++i) {
      const double difference = std::abs(static_cast<double>(one.bones[b][i / 4][i % 4]) -
                                         static_cast<double>(other.bones[b][i / 4][i % 4]));
      if (!(difference <= apart)) apart = difference;
    }
  }
  return apart;
}

double pose_angle(const muscle::SurfaceAsset& asset, const SurfacePose& pose) {
  double largest = 0.0;
  for (const muscle::SurfaceAttachmentAsset& attachment : asset.attachments) {
    if (attachment.bone < 0 || static_cast<std::size_t>(attachment.bone) >= pose.bones.size()) continue;
    const glm::dmat4 m(pose.bones[static_cast<std::size_t>(attachment.bone)]);
    const glm::dvec3 axis(m[1][2] - m[2][1], m[2][0] - m[0][2], m[0][1] - m[1][0]);  // 2 sin(angle) long
    largest = std::max(largest, std::atan2(glm::length(axis), m[0][0] + m[1][1] + m[2][2] - 1.0));
  }
  return largest;
}

std::vector<std::vector<std::uint64_t>> posed_steps(const SurfaceMuscleRun& run) {
  std::vector<std::vector<std::uint64_t>> poses;
  for (std::uint64_t step = 1; step <= std::min(run.poses.size(), run.steps.size()); ++step) {
    if (run.steps[step - 1].posed == 0.0) continue;
    const auto known = std::find_if(poses.begin(), poses.end(), [&](const std::vector<std::uint64_t>& pose) {
      return poses_apart(run.poses[pose.front() - 1], run.poses[step - 1]) <= kSamePose;
    });
    if (known == poses.end()) {
      poses.push_back({step});
    } else {
      known->push_back(step);
    }
  }
  std::stable_sort(poses.begin(), poses.end(), [&](const auto& one, const auto& other) {
    return pose_angle(*run.asset, run.poses[one.front() - 1]) < pose_angle(*run.asset, run.poses[other.front() - 1]);
  });
  return poses;
}

Repeats compare_repeats(const SurfaceMuscleRun& run) {
  Repeats repeats;
  for (const std::vector<std::uint64_t>& steps : posed_steps(run)) {
    for (std::size_t i = 1; i < steps.size(); ++i) {
      if (steps[i] == steps[i - 1] + 1) continue;  // it has only stayed
      const auto& first = run.poses[steps[0] - 1].shape;
      add(compare_shapes(*run.asset, first, run.poses[steps[i] - 1].shape).largest, steps[i], repeats);
    }
  }
  for (const SurfaceRevisit& visit : run.revisits) {
    if (visit.how != Revisit::kIterated) add(visit.largest, visit.step, repeats);
  }
  return repeats;
}

Repeats compare_iterated(const SurfaceMuscleRun& run) {
  Repeats repeats;
  for (const SurfaceRevisit& visit : run.revisits) {
    if (visit.how == Revisit::kIterated) add(visit.largest, visit.step, repeats);
  }
  return repeats;
}

std::vector<PosePair> pair_poses(const SurfaceMuscleRun& posed, const SurfaceMuscleRun& smooth) {
  std::size_t end = 0;  // the smooth run's way to its largest angle
  for (std::size_t i = 0; i < smooth.poses.size(); ++i) {
    if (i == 0 || pose_angle(*smooth.asset, smooth.poses[i]) > pose_angle(*smooth.asset, smooth.poses[end])) end = i;
  }
  std::vector<PosePair> pairs;
  for (const std::vector<std::uint64_t>& steps : posed_steps(posed)) {
    const SurfacePose& pose = posed.poses[steps.front() - 1];
    PosePair pair{.angle = pose_angle(*posed.asset, pose), .step = steps.front(), .apart = kBesidePose};
    for (std::size_t i = 0; i <= end && i < smooth.poses.size(); ++i) {
      const double apart = poses_apart(pose, smooth.poses[i]);
      if (!(apart < pair.apart)) continue;
      pair.apart = apart;
      pair.beside = i + 1;
    }
    if (pair.beside == 0) continue;
    pair.shapes = compare_shapes(*posed.asset, pose.shape, smooth.poses[pair.beside - 1].shape);
    pairs.push_back(pair);
  }
  return pairs;
}

double bend_ratio(const SurfaceMuscleRun& posed, const SurfaceMuscleRun& smooth, const PosePair& pair) {
  const double bend = posed.steps[pair.step - 1].dihedral_mean, beside = smooth.steps[pair.beside - 1].dihedral_mean;
  if (!std::isfinite(bend) || !std::isfinite(beside)) return std::numeric_limits<double>::quiet_NaN();
  return bend <= kLeastBend ? 0.0 : bend / std::max(beside, kLeastBend);
}

}  // namespace fascicle::cook
