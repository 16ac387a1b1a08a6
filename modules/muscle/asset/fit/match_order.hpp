// Matches (2.2): opposite rays that found the same stretch of surface because the centre lies outside of the slice.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace fascicle::muscle {

// Writes the matches of one section in winding order, each as the vertex i+ with the positive radius; its opposite has
// the negative one. `radii`: one a ray, an even number; `hits`: not 0 where the ray found the mesh.
//
// Sorted by i+ in the cyclic group, starting after the largest gap, so that the order winds along the slice once. Of
// equal gaps, that which follows the lowest i+ counts. (The article's algorithm 1, as printed, is wrong even for
// |C| = 6.)
void order_matches(std::span<const double> radii, std::span<const std::uint8_t> hits,
                   std::vector<std::uint32_t>& ordered);

}  // namespace fascicle::muscle
