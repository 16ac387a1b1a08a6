// Places along a muscle's line.
#pragma once

#include <span>

#include <glm/vec3.hpp>

#include "modules/muscle/asset/hull/hull_asset.hpp"

namespace fascicle::muscle {

// Where a line is at rest after a part 0..1 of its length, and where it is now (`line`, a place a point): in the same
// segment, as far along it. A line of one point is there; of none, at zero.
glm::vec3 rest_place_along(std::span<const HullLinePoint> rest, float along);
glm::vec3 place_along(std::span<const HullLinePoint> rest, std::span<const glm::vec3> line, float along);

}  // namespace fascicle::muscle
