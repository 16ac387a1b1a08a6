// The directions in which a mesh's surface is longest and shortest.
#pragma once

#include <array>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "engine/content/triangle_mesh.hpp"

namespace fascicle {

struct PrincipalAxes {
  glm::dvec3 centre{0.0};  // m, centroid of the surface
  // Unit, right-handed, by falling deviation. Each of the first two points to where the surface reaches thinner and
  // farther (positive third moment), so that it turns with the mesh; for a mesh that is symmetric along it the
  // direction's greatest component is positive.
  std::array<glm::dvec3, 3> axes{glm::dvec3(1, 0, 0), glm::dvec3(0, 1, 0), glm::dvec3(0, 0, 1)};
  std::array<double, 3> deviations{};  // m, standard deviation of the surface along each
  std::array<glm::dvec2, 3> ranges{};  // m, lowest and highest vertex along each, from the centre
};

// Moments are those of the area, so open and inverted meshes have axes too. Triangles with a corner that is not finite
// do not count. A mesh without area: the coordinate axes round the mean of its corners.
PrincipalAxes principal_axes(const TriangleMesh& mesh);

}  // namespace fascicle
