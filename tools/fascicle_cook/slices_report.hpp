// A slice analysis as text: CSV for programs, a table and a summary for people.
#pragma once

#include <span>
#include <string>

#include "engine/geometry/slice_analysis.hpp"

namespace fascicle::cook {

// One line a loop: mesh, fraction, loop (0: the slice's outline), closed, area (mm^2; negative: a hole), perimeter
// (mm), quotient, normalised perimeter, dent, convex, centroid inside. A slice that misses its mesh has a line without
// a loop.
std::string slices_csv(std::span<const MeshSlice> slices);

// One line a slice.
std::string slices_table(std::span<const MeshSlice> slices);

// The summary, beside what the method's authors found.
std::string describe_slices(const SliceSummary& summary, std::size_t meshes);

}  // namespace fascicle::cook
