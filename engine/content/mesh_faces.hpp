// Polygons and strips of mesh files as triangles: what all readers of polygons share.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace fascicle {

// The fan of a polygon's first corner. Fewer than three corners give nothing.
void add_polygon(std::span<const std::uint32_t> corners, std::vector<std::uint32_t>& indices);

// A strip of triangles, every other one turned. Those with a corner twice, by which strips turn corners, are left out.
void add_strip(std::span<const std::uint32_t> corners, std::vector<std::uint32_t>& indices);

}  // namespace fascicle
