// A run of surface muscles as pictures, like the method's authors' figures 11 to 21.
#pragma once

#include <string>
#include <vector>

#include "tools/fascicle_cook/surface_run.hpp"

namespace fascicle::cook {

struct SurfacePlot {
  std::string what;  // volume, edges, dihedral, bones, fibres, residuals
  std::string svg;
};

// Against the step: volume ratio; mean edge ratio with its middle 90 % and, below, the extremes; dihedral change; depth
// in bones and distance from rest; the length of every fibre, one line each, where there are fibres. Of muscles that their hulls
// posed, against the iteration: how far it moved a vertex, in some poses; below, in poses that were
// iterated further, and of the full mesh.
std::vector<SurfacePlot> surface_plots(const SurfaceRun& run, const SurfaceMuscleRun& muscle);

}  // namespace fascicle::cook
