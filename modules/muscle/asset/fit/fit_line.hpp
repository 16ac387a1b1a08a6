// The method's algorithm (2.3) for one line of sections and one mesh.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

#include "modules/muscle/asset/fit/fit_muscles.hpp"
#include "modules/muscle/asset/fit/fit_surface.hpp"
#include "modules/muscle/asset/fit/rest_frames.hpp"

namespace fascicle::muscle {

struct LineFit {
  std::vector<glm::dvec3> centres;      // m, a_k
  std::vector<double> radii;            // m, |C| a section
  std::vector<SectionReport> sections;
  EndNormals end_normals;               // where an area gives them
  bool any_hit = false;                 // false: the sections miss the mesh altogether
};

// Two sweeps: the first finds an inner point for every centre that is outside, from CSS |C| rays; then the ends go back
// to where the model has them and all planes are found anew, because moved neighbours turn them; the second casts the
// |C| final rays. `points`: at least 2, the sections' centres before the fit, m. `origin_bone`: the linear part of the
// origin bone's rest matrix. `areas`: the attachment areas at the origin and the insertion, by themselves; without
// triangles: none, the end section is cast like the others.
LineFit fit_line(const FitSurface& surface, std::span<const glm::dvec3> points, const glm::dmat3& origin_bone,
                 std::uint32_t section_vertices, const std::array<TriangleMesh, 2>& areas, const FitOptions& options);

}  // namespace fascicle::muscle
