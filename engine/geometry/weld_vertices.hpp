// Finds vertices that stand at one place, by a hash grid whose cells are four tolerances wide.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

namespace fascicle {

// For each position the index of the one that stands for it: the first in the list that stands for itself and is no
// further away than `tolerance`, else its own. Positions are finite. Linear in their number.
std::vector<std::uint32_t> weld_vertices(std::span<const glm::vec3> positions, double tolerance);

}  // namespace fascicle
