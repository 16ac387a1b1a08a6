// Keeps neighbouring sections from passing through each other (ours). Where a line bends, the planes of its sections
// cross on the inside of the bend; radii that reach beyond the crossing fold the surface over itself.
#pragma once

#include <span>

#include <glm/vec2.hpp>

#include "modules/muscle/asset/fit/rest_frames.hpp"

namespace fascicle::muscle {

// Shortens each positive radius that passes the plane of the section before or after it to where it meets that plane.
// `radii`: one a direction for each frame, m.
void unfold_sections(std::span<const SectionFrame> frames, std::span<const glm::dvec2> directions,
                     std::span<double> radii);

}  // namespace fascicle::muscle
