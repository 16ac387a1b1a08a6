// What is asked of the surface muscles of the scenes that the method's authors published (4.3): limits on the figures
// of a run, each with what was found.
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

// The checks of the scene, by its name: those of `box`, of `gluteus` and of `iliacus` are the published scenes'. Any
// other scene is only asked for volume, attachments and depth.
std::vector<SurfaceCheck> check_surface(const std::string& scene, const SurfaceMuscleRun& run);

bool all_passed(const std::vector<SurfaceCheck>& checks);

}  // namespace fascicle::cook
