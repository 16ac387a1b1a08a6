// How a contact's sample hangs on centres and radii.
#pragma once

#include "modules/muscle/asset/collision/collision_asset.hpp"
#include "modules/muscle/kernels/collision/collision_work.hpp"

namespace fascicle::muscle {

// The way a sample's surface looks: about its radius' direction (unit).
glm::vec3 sample_direction(const CollisionAsset& asset, const CollisionWork& work, std::uint32_t row,
                           std::uint32_t sample);

// Fills the sample's part of a contact with its normal set: place, sections, weights, levers. False where nothing that
// carries it can move.
bool carry_sample(const CollisionAsset& asset, const CollisionWork& work, std::uint32_t row, std::uint32_t sample,
                  Contact& contact);

// The other muscle's part: the point on edge (edge, edge + 1), at `fraction` along it, `along` between the sections.
void carry_outline(const CollisionAsset& asset, const CollisionWork& work, std::uint32_t section, float along,
                   std::uint32_t edge, float fraction, Contact& contact);

// Works out the constraint's mass and keeps it, unless there is no room or nothing can move.
void add_contact(Contact& contact, CollisionWork& work);

}  // namespace fascicle::muscle
