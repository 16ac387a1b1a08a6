// Removes triangles that bound nothing: without area, or twice.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

namespace fascicle {

struct DroppedTriangles {
  std::size_t degenerate = 0, duplicate = 0;
};

// Edits `indices`, three a triangle, and `sources`, one a triangle. Of triangles with the same three corners, in
// whatever order, the first stays. A triangle with a corner twice goes. So does one that is lower than `tolerance`
// (m), though its corners differ; because its neighbours would part, the one across its longest edge is split at its
// third corner. What then still has no area after a few rounds goes, too, and leaves a hole.
DroppedTriangles drop_triangles(std::span<const glm::vec3> positions, double tolerance,
                                std::vector<std::uint32_t>& indices, std::vector<std::uint32_t>& sources);

}  // namespace fascicle
