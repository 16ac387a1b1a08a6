// A rigid frame on a musculotendon unit's line, for what rides on it.
#pragma once

#include <cstdint>

#include <glm/mat4x4.hpp>

#include "modules/muscle/asset/muscle_asset.hpp"
#include "modules/muscle/components/action_lines.hpp"
#include "modules/muscle/components/cross_sections.hpp"

namespace fascicle::muscle {

// At `place` along the line, whatever its level of detail: attachment i is at i, half of the sections to the next at
// i + 0.5. Columns u, v, t and the centre: section's frame -> world now, or at rest.
glm::mat4 section_frame(const MuscleAsset& asset, const ActionLines& lines, const CrossSections& sections,
                        std::uint32_t muscle, float place);
glm::mat4 rest_section_frame(const MuscleAsset& asset, std::uint32_t muscle, float place);

}  // namespace fascicle::muscle
