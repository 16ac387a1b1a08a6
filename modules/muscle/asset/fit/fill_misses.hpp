// Radii for the rays that found nothing (2.1: "the vertex keeps its radius and is flagged as a miss"; initial radii
// there are none).
#pragma once

#include <cstdint>
#include <span>

namespace fascicle::muscle {

// `radii` and `hits` hold `count` rays for each section; `arcs` the sections' places along the line, rising, m.
// A missing radius is interpolated between the rays on both sides of it in its section; in a section without hits,
// between the sections on both sides of it; beyond the first or last section with hits it is that section's. At least
// one ray has hit.
void fill_misses(std::uint32_t count, std::span<const double> arcs, std::span<const std::uint8_t> hits,
                 std::span<double> radii);

}  // namespace fascicle::muscle
