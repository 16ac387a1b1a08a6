// Where fibres are while the surface that they are bound to deforms, and how long they are. Made for every step: a
// point is four gathers of 16 bytes and a normal, so a thousand fibres of ten points take some tens of microseconds.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "modules/muscle/asset/surface/surface_asset.hpp"

namespace fascicle::muscle {

// A fibre's point is sum(weight * vertex) + rise * n, n the unit normal of the triangle of the first three vertices,
// (b - a) x (c - a). Weights sum to 1; see asset/fibres/bind_fibres.hpp for what they are.
struct FibreBinding {
  std::array<std::uint32_t, 4> vertex{};
  std::array<float, 4> weight{};
  float rise = 0.0f;                       // m
};

struct PlaceFibresJob {
  std::span<const FibreBinding> bindings;  // fibre after fibre
  std::uint32_t points_per_fibre = 0;
  std::span<const SurfacePoint> surface;   // every vertex that a binding names
  std::span<SurfacePoint> points;          // out, by binding: m; inverse_mass 0
  std::span<float> lengths;                // out, by fibre: m, along its points
};

void place_fibres(const PlaceFibresJob& job);

}  // namespace fascicle::muscle
