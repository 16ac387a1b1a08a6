// The picture of a slice analysis as SVG: on the left each slice's isoperimetric quotient against its perimeter, on the
// right all outlines over one another, scaled to one area.
#pragma once

#include <span>
#include <string>

#include "engine/geometry/slice_analysis.hpp"

namespace fascicle::cook {

// Slices that miss their mesh are left out.
std::string plot_slices(const std::string& title, std::span<const MeshSlice> slices);

}  // namespace fascicle::cook
