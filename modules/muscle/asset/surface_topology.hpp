// The constant index buffers of a muscle's drawn surface (1.5) and its tetrahedra (1.6). Both split each side's
// quadrilateral along the same diagonal, from c_i^k to c_{i+1}^{k+1}.
#pragma once

#include <cstdint>
#include <vector>

#include "modules/muscle/asset/muscle_asset.hpp"

namespace fascicle::muscle {

// Appends a strip for each segment between drawn rows: 2 (|C| + 1) indices, anticlockwise seen from outside.
void append_strips(const SectionLayout& layout, std::vector<std::uint32_t>& indices);

// Appends the two caps: centre, |C| vertices and the first of them again.
void append_fans(const SectionLayout& layout, std::vector<std::uint32_t>& indices);

}  // namespace fascicle::muscle
