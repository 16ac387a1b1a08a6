// Where a tag (collision_description.hpp) lies on a muscle at rest, and which tag a place is: the same point of the
// surface, but for the spacing of sections and vertices, at every |C| and LSS and with every fit.
#pragma once

#include <cstdint>

#include <glm/vec3.hpp>

#include "modules/muscle/asset/collision/collision_asset.hpp"
#include "modules/muscle/asset/collision/collision_description.hpp"
#include "modules/muscle/asset/muscle_asset.hpp"

namespace fascicle::muscle {

// The tag of vertex i of section k.
SectionTag tag_of(const MuscleAsset& asset, std::uint32_t muscle, std::uint32_t section, std::uint32_t vertex);

// m: the tagged place at rest; between sections and vertices, centres, frames and radii are mixed.
glm::vec3 tagged_place(const MuscleAsset& asset, const SectionTag& tag);

// The same place of another muscle that is this one reflected in the plane `axis` = 0 of the rest space: the tag of
// `other` at the same fraction whose direction from the line is the reflected one.
SectionTag mirror_tag(const MuscleAsset& asset, const SectionTag& tag, std::uint32_t other, int axis);

}  // namespace fascicle::muscle
