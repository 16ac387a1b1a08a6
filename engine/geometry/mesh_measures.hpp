// Sizes of triangle meshes: bounds, area, enclosed volume. Triangles with a corner that is not finite do not count.
#pragma once

#include <glm/vec3.hpp>

#include "engine/content/triangle_mesh.hpp"

namespace fascicle {

struct Bounds {
  glm::vec3 lower{0.0f}, upper{0.0f};  // m

  float diagonal() const;  // m
};

// Of the vertices that triangles use; zero for a mesh without triangles.
Bounds mesh_bounds(const TriangleMesh& mesh);

// m^2.
double mesh_area(const TriangleMesh& mesh);

// m^3: positive for a closed mesh whose triangles turn anticlockwise seen from outside. Where shells overlap it counts
// twice.
double mesh_volume(const TriangleMesh& mesh);

}  // namespace fascicle
