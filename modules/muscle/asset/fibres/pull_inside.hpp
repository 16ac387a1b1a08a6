// Brings points inside a closed mesh: one outside goes to the nearest place of the surface and a margin further in, one
// that is inside but nearer to the surface than the margin goes in to it.
#pragma once

#include <cstdint>
#include <span>

#include <glm/vec3.hpp>

#include "engine/content/triangle_mesh.hpp"

namespace fascicle::muscle {

struct PulledPoints {
  std::uint32_t outside = 0;     // that were outside
  float furthest = 0.0f;         // m, that one was moved
  std::uint32_t failed = 0;      // that are outside still
};

// Where the mesh is thinner than two margins (m) a point goes to the middle.
PulledPoints pull_inside(const TriangleMesh& mesh, double margin, std::span<glm::dvec3> points);

}  // namespace fascicle::muscle
