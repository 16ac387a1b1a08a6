// A point that should lie inside the slice of the mesh, from the ordered matches (2.2).
#pragma once

#include <cstdint>
#include <span>

#include <glm/vec2.hpp>

namespace fascicle::muscle {

// In the section's plane, from its centre, m. Of an odd number of matches, the midpoint of the middle one's two surface
// points; of an even number, the area centroid of the quadrilateral of the two middle ones. (The article takes the mean
// of the four vertices, the thesis the centroid.) No match: zero. `radii` and `directions`: one a ray, directions unit.
glm::dvec2 inner_point(std::span<const std::uint32_t> ordered, std::span<const double> radii,
                       std::span<const glm::dvec2> directions);

}  // namespace fascicle::muscle
