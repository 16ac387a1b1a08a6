// What RayScene answers, by the plain scalar loop of Moller and Trumbore (1997) over all triangles: the oracle of its
// tests and the yardstick of its benchmarks, built with the same flags.
#pragma once

#include <span>
#include <vector>

#include "engine/geometry/ray_scene.hpp"

namespace fascicle {

// Extremes of each line, one pass over the triangles a line.
void cast_lines_reference(const TriangleMesh& mesh, std::span<const Line> lines, std::span<LineExtremes> extremes);

// Appends every crossing of one line, in the triangles' order, shared edges and vertices possibly twice.
void cross_line_reference(const TriangleMesh& mesh, const Line& line, std::vector<LineCrossing>& crossings);

}  // namespace fascicle
