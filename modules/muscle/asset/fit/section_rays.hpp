// Rays of cross sections: from the centre outward in the section's plane, evenly round, each opposite pair cast as one
// line (engine/geometry/ray_scene.hpp).
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <glm/vec2.hpp>

#include "modules/muscle/asset/fit/fit_surface.hpp"
#include "modules/muscle/asset/fit/rest_frames.hpp"
#include "modules/muscle/asset/fit/section_slice.hpp"

namespace fascicle::muscle {

// Unit directions (cos, sin) of theta_i = 2 pi i / count, in a section's u and v.
std::vector<glm::dvec2> ray_directions(std::uint32_t count);

// What `count` rays a section found: ray i of section k at [k count + i].
struct SectionRays {
  std::uint32_t count = 0;                 // a section, even
  std::vector<double> radii;               // m, algebraic (1.3); 0 where nothing was hit
  std::vector<std::uint8_t> hits;          // 1: the ray found the mesh
  std::vector<std::uint32_t> most_crossings;  // by section, of one line; over 2: concave, or in several loops

  std::span<const double> radii_of(std::size_t section) const {
    return std::span(radii).subspan(section * count, count);
  }
  std::span<const std::uint8_t> hits_of(std::size_t section) const {
    return std::span(hits).subspan(section * count, count);
  }
};

void cast_sections(const FitSurface& surface, std::span<const SectionFrame> frames,
                   std::span<const glm::dvec2> directions, SectionRays& rays);

// The same for one section that belongs to one slice alone.
void cast_slice(const SectionSlice& slice, std::size_t section, std::span<const glm::dvec2> directions,
                SectionRays& rays);

// The line from a section's centre in a direction of its plane.
Line section_line(const SectionFrame& frame, const glm::dvec2& direction);

}  // namespace fascicle::muscle
