// Whether two triangles of a mesh pass through each other.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include <glm/vec3.hpp>

namespace fascicle {

// True when an edge of one passes through the other, or both lie in one plane and share an area. Triangles that only
// touch, as neighbours do at their common corners, do not cross. Signs are decided by determinants in double precision;
// one below its rounding error counts as zero, that is, as touching.
bool triangles_cross(std::span<const glm::vec3> positions, const std::array<std::uint32_t, 3>& first,
                     const std::array<std::uint32_t, 3>& second);

}  // namespace fascicle
