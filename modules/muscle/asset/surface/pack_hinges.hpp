// Hinges in colours and packs: no two hinges of a colour share a vertex, so that 16 of them can be solved side by side
// and what comes out does not depend on how many are.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "modules/muscle/asset/surface/surface_asset.hpp"

namespace fascicle::muscle {

struct PackedHinges {
  std::vector<std::uint32_t> order;       // of the hinges in the packs, spare lanes left out
  AlignedVector<HingePack> packs;
  std::vector<std::uint32_t> first_pack;  // by colour, and one more
};

// Greedy, in the given order: each hinge gets the lowest colour that none of its vertices has. Spare lanes have the
// padding points from `vertex_count` on, four a lane.
PackedHinges pack_hinges(std::span<const Hinge> hinges, std::uint32_t vertex_count, const SurfaceSettings& settings);

// Gives the hinges the lengths and angles that they have among `points` (with padding), by the very code that solves
// them, so that a mesh at rest is exactly so.
void measure_hinges(std::span<const SurfacePoint> points, std::span<Hinge> hinges);

// Points for spare lanes to move: a flat hinge for each, without mass.
void add_padding(AlignedVector<SurfacePoint>& points);

}  // namespace fascicle::muscle
