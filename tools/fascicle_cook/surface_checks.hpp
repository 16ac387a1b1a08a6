// What is asked of the surface muscles of the scenes that the method's authors published (4.3): limits on the figures of
// a run, each with what was found.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "tools/fascicle_cook/surface_run.hpp"

namespace fascicle::cook {

// A muscle that has been deeper than this in a bone was carried through it. Its shape then says nothing about the
// solver: one that is only carried, or left where it is, keeps its shape perfectly.
inline constexpr double kThroughBone = 2.0;  // mm

struct SurfaceCheck {
  std::string what;
  std::string limit;         // in words
  double found = 0.0;
  std::uint64_t step = 0;    // at which that was found
  bool reached = true;       // false: the run ended before the step that is asked about
  bool passed = false;
  std::string why;           // where it failed by something else than its limit
};

// The checks of the scene, by its name: those of `box`, of `gluteus` and of `iliacus` are the published scenes'. Any
// other scene is only asked for volume, attachments and depth.
std::vector<SurfaceCheck> check_surface(const std::string& scene, const SurfaceMuscleRun& run);

bool all_passed(const std::vector<SurfaceCheck>& checks);

}  // namespace fascicle::cook
