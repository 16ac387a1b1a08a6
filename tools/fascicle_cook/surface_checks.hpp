// What is asked of the surface muscles of the scenes that the method's authors published (4.3), and of any that are
// posed by their coarse hulls (4.5): limits on the figures of a run, each with what was found.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "tools/fascicle_cook/surface_run.hpp"

namespace fascicle::cook {

// A run is void from the step on at which the muscle is deeper than this in a bone, has lost or gained this much of
// its volume (not the box, which has no room for it), or an attached vertex is this far from its bone. A muscle that is
// only carried by its bones, or left where it is, comes back to its shape by itself: that says nothing about the
// solver.
inline constexpr double kVoidDepth = 2.0;       // mm
inline constexpr double kVoidVolume = 0.05;     // of the volume at rest
inline constexpr double kVoidAttachment = 2.0;  // mm

struct SurfaceCheck {
  std::string what;
  std::string limit;         // in words
  double found = 0.0;
  std::uint64_t step = 0;    // at which that was found
  bool reached = true;       // false: the run ended before the step that is asked about
  bool passed = false;
  std::string why;           // where it fails although it is within its limit
};

// Of muscles that their hulls pose.
inline constexpr double kMostIterations = 10.0;
inline constexpr double kRepeatTolerance = 1.0e-5;  // of the muscle's size
inline constexpr double kIteratedTolerance = 1.0e-3;  // likewise: what more iterations would change
inline constexpr double kMostBend = 1.2;            // times position based dynamics' mean dihedral change

// The checks of the scene, by its name: those of `box`, of `gluteus` and of `iliacus` are the published scenes'. Any
// other scene is only asked for volume, attachments and depth. A muscle that its hull posed in some step is asked what
// the coarse hull must do, whatever the scene. `smooth`: the same muscle by dynamics, to compare with (pair_poses).
std::vector<SurfaceCheck> check_surface(const std::string& scene, const SurfaceMuscleRun& run,
                                        const SurfaceMuscleRun* smooth = nullptr);

bool all_passed(const std::vector<SurfaceCheck>& checks);

}  // namespace fascicle::cook
