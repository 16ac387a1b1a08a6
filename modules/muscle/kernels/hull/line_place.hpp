// Places along a muscle's line.
#pragma once

#include <span>

#include <glm/vec3.hpp>

namespace fascicle::muscle {

// After a part 0..1 of a polyline's length. A line that is bent over a bone by one of its segments is stretched there
// and nowhere else; a muscle slides along its line and is stretched evenly, so places are told by length, not by segment.
// A line without a length is where its first point is; one of no points, at zero.
glm::vec3 place_along(std::span<const glm::vec3> line, float along);

}  // namespace fascicle::muscle
