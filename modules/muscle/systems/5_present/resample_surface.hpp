// What a musculature draws now, as a neighbouring level of detail draws it: for renderers that interpolate between
// steps, which at an exchange of levels need the last step's surface in the new level's layout.
#pragma once

#include <cstdint>
#include <span>

#include "modules/muscle/components/muscle_surfaces.hpp"
#include "modules/muscle/components/tendons.hpp"

namespace fascicle::muscle {

struct MuscleLevels;

// Writes `surfaces` of level `from` (where it draws the same as the other) by the layout of level `to`, which is the
// next coarser or finer one; `vertices` and `rows` are that asset's, written in order and never read. Vertices that
// both levels have are copied, those that the finer one has alone lie in the middle of two or four of the coarser's.
void resample_surface(const MuscleLevels& levels, std::uint32_t from, const Tendons& tendons,
                      const MuscleSurfaces& surfaces, std::uint32_t to, std::span<SurfaceVertex> vertices,
                      std::span<SurfaceRow> rows);

}  // namespace fascicle::muscle
