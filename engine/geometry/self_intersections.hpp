// Finds out whether a surface passes through itself.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include <glm/vec3.hpp>

namespace fascicle {

struct SelfIntersections {
  std::size_t pairs = 0;  // of triangles, each counted once
  bool more = false;      // the search ended early: there may be more
};

// Counts pairs of triangles that cross (see triangles_cross). The search ends once there are `max_pairs`, or when so
// many boxes of triangles overlap that testing them all would take minutes. The same for any number of threads.
SelfIntersections find_self_intersections(std::span<const glm::vec3> positions, std::span<const std::uint32_t> indices,
                                          std::size_t max_pairs = 1000);

}  // namespace fascicle
