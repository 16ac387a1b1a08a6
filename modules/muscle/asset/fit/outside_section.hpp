// Radii of a section whose centre lies outside of the mesh, as an end may that the model fixes to a bone (ours). Rays
// from outside see the slice from one side only, and where the plane also cuts another part of a bent muscle they see
// that.
#pragma once

#include <cstdint>
#include <span>

#include <glm/vec2.hpp>

#include "modules/muscle/asset/fit/section_slice.hpp"

namespace fascicle::muscle {

// A slice nearer than its own size (the root of its area) is taken for the section's: its far side bounds the section,
// which narrows to a point at the centre's side. Otherwise all rays count as misses, so that the radii go on from the
// neighbours' (fill_misses). `slices`: those of the section's plane; radii (m) and hits: one a direction.
void shape_outside_section(std::span<const SectionSlice> slices, std::span<const glm::dvec2> directions,
                           std::span<double> radii, std::span<std::uint8_t> hits);

}  // namespace fascicle::muscle
