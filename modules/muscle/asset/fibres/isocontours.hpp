// The rings in which a scalar field cuts a muscle's surface (4.4): one closed loop a level, evenly spaced along the
// muscle, all turning the same way, their starting points aligned so that neighbours are not twisted.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

#include "engine/geometry/mesh_edges.hpp"

namespace fascicle::muscle {

using Loop = std::vector<glm::dvec3>;  // m; closed: the first point is not repeated

// All loops of one level of a closed mesh, the longest first. Seen from outside the muscle, the higher values lie to
// the right of its way. A vertex exactly on the level counts as above it.
std::vector<Loop> trace_level(std::span<const glm::vec3> positions, std::span<const std::uint32_t> triangles,
                              const MeshEdges& edges, std::span<const float> field, double level);

double loop_length(const Loop& loop);
glm::dvec3 loop_centre(const Loop& loop);  // of the curve

// `count` points from `start` (m along the loop, any number) on, evenly spaced along it.
Loop resample_loop(const Loop& loop, std::size_t count, double start = 0.0);

struct Contours {
  std::vector<Loop> loops;             // from level 0 to 1, with kContourPoints points each
  double length = 0.0;                 // m, of the line through the loops' centres
  std::uint32_t split_levels = 0;      // levels of several loops, of which the longest was taken
};

inline constexpr std::size_t kContourPoints = 96;

// `field` is 0 at one end and 1 at the other. The middle loop starts on its narrowest width, the others are aligned
// from loop to loop. Empty where the field cuts nowhere.
Contours trace_contours(std::span<const glm::vec3> positions, std::span<const std::uint32_t> triangles,
                        std::span<const float> field, std::size_t count);

}  // namespace fascicle::muscle
