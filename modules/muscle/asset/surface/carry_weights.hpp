// How far each carrier takes a vertex with it before the constraints refine it.
//
// Bones: harmonic weights, 1 on the bone's own attached vertices and 0 on those of all others. As a bone turns by a
// little, a vertex turns by its share of it; over many steps these shares add up to a rotation, so nothing shrinks as
// it does where matrices are blended once. Sections of a driving musculotendon unit: the two between whose centres the
// vertex lies at rest.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

#include "engine/content/result.hpp"
#include "modules/muscle/asset/surface/surface_asset.hpp"

namespace fascicle::muscle {

struct Carriage {
  std::vector<SurfaceCarrier> carriers;
  std::vector<CarryWeights> weights;  // by vertex; empty: nothing carries it
};

// `attachment_of`: by vertex, index in `attachments`, or -1. Nothing is carried where there is no attachment, or only
// some to `frame_bone`, which does not move in the simulation's frame.
Result<Carriage> carry_by_bones(std::span<const glm::vec3> positions, std::span<const std::uint32_t> triangles,
                                std::span<const std::int32_t> attachment_of,
                                std::span<const SurfaceAttachmentAsset> attachments, std::int32_t frame_bone);

// `muscle` of `muscles`; positions in the same rest space.
Carriage carry_by_sections(std::span<const glm::vec3> positions, const MuscleAsset& muscles, std::uint32_t muscle);

}  // namespace fascicle::muscle
