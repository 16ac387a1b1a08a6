// State: the surfaces as they are drawn or read by a game. On a musculature's entity.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include <glm/vec3.hpp>

#include "engine/math/aligned_vector.hpp"

namespace fascicle::muscle {

struct MuscleAsset;

// 16 bytes; the normal is unit, packed as GL_INT_2_10_10_10_REV.
struct SurfaceVertex {
  glm::vec3 position{0.0f};  // m, world
  std::uint32_t normal = 0;
};
static_assert(sizeof(SurfaceVertex) == 16);

glm::vec3 unpack_surface_normal(std::uint32_t packed);

// Per drawn row. The coordinate is zero on C_t, falls to minus the tendon's length at its bone and rises to half the
// belly's length; kNoTendon where the muscle has none.
struct SurfaceRow {
  float tendon_coordinate = 0.0f;  // m along the line to the nearest tendon border; negative: tendon
  std::uint32_t muscle = 0;
};
inline constexpr float kNoTendon = 1.0f;  // m

struct MuscleSurfaces {
  AlignedVector<SurfaceVertex> vertices;  // in the order of MuscleAsset's vertices
  AlignedVector<SurfaceRow> rows;
};

// One muscle's part. Indices are those of the asset: they count from the musculature's vertex 0, and
// `first_vertex` tells where `vertices` starts.
struct MuscleSurfaceView {
  std::span<const SurfaceVertex> vertices;
  std::span<const SurfaceRow> rows;
  std::span<const std::uint32_t> strips;  // restart index 0xffffffff
  std::span<const std::uint32_t> fans;
  std::uint32_t first_vertex = 0;
  std::uint32_t section_vertices = 0;     // |C|
};
MuscleSurfaceView surface_of(const MuscleAsset& asset, const MuscleSurfaces& surfaces, std::uint32_t muscle);

std::size_t heap_bytes(const MuscleSurfaces& surfaces);

}  // namespace fascicle::muscle
