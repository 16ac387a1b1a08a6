// The areas of the sections as they are drawn, against what they should be.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "modules/muscle/asset/muscle_asset.hpp"
#include "modules/muscle/components/muscle_surfaces.hpp"
#include "modules/muscle/components/tendons.hpp"

namespace fascicle::muscle {

// m^2, of each section's polygon, muscle after muscle; tendon sections, which are between two of them, have none.
void measure_section_areas(const MuscleAsset& asset, const MuscleSurfaces& surfaces, const Tendons& tendons,
                           std::vector<float>& areas);

struct AreaError {
  float relative = 0.0f;  // of the target, without sign; infinity where an area is not finite
  std::uint32_t muscle = 0, section = 0;
};
// The worst. Targets (m^2) and areas one a section; targets of zero do not count, nor do first and last sections.
AreaError worst_area_error(const MuscleAsset& asset, std::span<const float> areas, std::span<const float> targets);

}  // namespace fascicle::muscle
