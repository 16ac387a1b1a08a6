// First step of building an asset: where each muscle's sections, radii, rows, vertices and indices lie, and the points'
// bindings to bones. Expects descriptions that check_descriptions found no fault in.
#pragma once

#include <span>

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

#include "modules/muscle/asset/build_muscle_asset.hpp"

namespace fascicle::muscle {

// Where an attachment is at rest, m.
glm::dvec3 rest_place(const AttachmentDescription& attachment, std::span<const glm::mat4> rest_bones);

// Lengths, drawn tendons (their sections take rows) and everything that follows from counts.
void lay_out_muscles(std::span<const MuscleDescription> descriptions, std::span<const glm::mat4> rest_bones,
                     MuscleAsset& asset);

// The points' bindings, and their places at rest.
void bind_points(std::span<const MuscleDescription> descriptions, std::span<const glm::mat4> rest_bones,
                 std::span<const MuscleFit> fits, MuscleAsset& asset);

}  // namespace fascicle::muscle
