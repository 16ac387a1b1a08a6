// The poses of a run, whatever their order (4.5): which are alike, how their shapes differ, and which pose of another
// run of the same muscle is beside each.
#pragma once

#include <cstdint>
#include <vector>

#include "tools/fascicle_cook/surface_run.hpp"

namespace fascicle::cook {

// Poses whose bones are nowhere further from each other than this are one (entries of matrices: m, or 1). Bones are
// single precision.
inline constexpr double kSamePose = 1.0e-6;
// Those of another run count as beside each other up to this.
inline constexpr double kBesidePose = 1.0e-3;

double poses_apart(const SurfacePose& one, const SurfacePose& other);

// rad: the largest turn since rest of a bone that the muscle is attached to, beside its frame.
double pose_angle(const muscle::SurfaceAsset& asset, const SurfacePose& pose);

// The steps of each pose that the hull made, in their order; poses by their angle.
std::vector<std::vector<std::uint64_t>> posed_steps(const SurfaceMuscleRun& run);

// The largest difference between shapes of one pose, over all poses that were taken again after another one: in the run
// and as revisits. `count` of them; 0: the run tells nothing.
struct Repeats {
  double largest = 0.0;      // of the muscle's size
  std::uint64_t step = 0;    // at which it was found
  std::size_t count = 0;
};
Repeats compare_repeats(const SurfaceMuscleRun& run);
// Likewise of those that were iterated further: what the solver's own word for "converged" is worth.
Repeats compare_iterated(const SurfaceMuscleRun& run);

// A pose of the hull's beside that of a run that goes to it smoothly, on its way to the largest angle.
struct PosePair {
  double angle = 0.0;                // rad
  std::uint64_t step = 0, beside = 0;  // of the two runs
  double apart = 0.0;                // the poses (kBesidePose)
  ShapeDifference shapes = {};
};
// One a pose, by angle. Both runs kept their poses. Poses that have none beside them are left out.
std::vector<PosePair> pair_poses(const SurfaceMuscleRun& posed, const SurfaceMuscleRun& smooth);

// The mean dihedral change to that beside it, which counts as kLeastBend at least. 0: the change itself is no larger.
inline constexpr double kLeastBend = 1.0e-3;  // rad
double bend_ratio(const SurfaceMuscleRun& posed, const SurfaceMuscleRun& smooth, const PosePair& pair);

}  // namespace fascicle::cook
