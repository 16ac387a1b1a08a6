// Where fibres are while the surface that they are bound to deforms, and how long they are. Made for every step: a
// point is four gathers of 16 bytes, so a thousand fibres of ten points take some tens of microseconds.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "modules/muscle/asset/surface/surface_asset.hpp"

namespace fascicle::muscle {

// A fibre's point is a convex combination of four of the surface's vertices: weights are not negative and sum to 1.
struct alignas(32) FibreBinding {
  std::array<std::uint32_t, 4> vertex{};
  std::array<float, 4> weight{};
};
static_assert(sizeof(FibreBinding) == 32);

struct PlaceFibresJob {
  std::span<const FibreBinding> bindings;  // fibre after fibre
  std::uint32_t points_per_fibre = 0;
  std::span<const SurfacePoint> surface;   // every vertex that a binding names
  std::span<SurfacePoint> points;          // out, by binding: m; inverse_mass 0
  std::span<float> lengths;                // out, by fibre: m, along its points
};

void place_fibres(const PlaceFibresJob& job);

}  // namespace fascicle::muscle
