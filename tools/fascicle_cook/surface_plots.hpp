// A run of surface muscles as pictures, like the method's authors' figures 11 to 21.
#pragma once

#include <string>
#include <vector>

#include "tools/fascicle_cook/surface_run.hpp"

namespace fascicle::cook {

struct SurfacePlot {
  std::string what;  // volume, edges, dihedral, bones, fibres
  std::string svg;
};

// Against the step: volume ratio; mean edge ratio with its middle 90 % and, below, the extremes; dihedral change; depth
// in bones and distance from rest; the length of every fibre, one line each, where there are fibres.
std::vector<SurfacePlot> surface_plots(const SurfaceRun& run, const SurfaceMuscleRun& muscle);

}  // namespace fascicle::cook
