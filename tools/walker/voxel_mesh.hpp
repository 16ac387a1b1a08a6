// The walker's only door to OpenVDB: a signed distance function becomes a closed triangle mesh, and many closed meshes
// become the one smooth surface that wraps them. OpenVDB stays behind this header because it compiles slowly.
#pragma once

#include <functional>
#include <span>

#include <glm/vec3.hpp>

#include "engine/content/triangle_mesh.hpp"

namespace fascicle::walker {

// Signed distance in metres, negative inside.
using Field = std::function<float(const glm::vec3&)>;

struct Box {
  glm::vec3 low{0.0f};   // m
  glm::vec3 high{0.0f};  // m
};

// The surface field = 0 inside `box`, sampled every `voxel` metres; outward, welded. `adaptivity` 0..1 merges flat
// regions into larger polygons.
TriangleMesh mesh_field(const Field& field, const Box& box, float voxel, float adaptivity);

struct WrapSettings {
  float voxel = 0.004f;       // m, of the grid on which the union is filtered
  float dilate = 0.014f;      // m, first outwards ...
  float erode = 0.008f;       // m, ... then back: closes gaps narrower than twice `dilate`
  int smooth_passes = 3;      // Gaussian filters between the two
  float mesh_voxel = 0.010f;  // m, edge length of the result
  float cut_height = 1.0f;    // m, nothing is kept above ...
  float floor_height = 0.0f;  // m, ... or below
};

// The smooth closed surface around the union of `parts`.
TriangleMesh wrap_meshes(std::span<const TriangleMesh> parts, const WrapSettings& settings);

}  // namespace fascicle::walker
