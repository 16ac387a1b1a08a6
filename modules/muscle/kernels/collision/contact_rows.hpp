// How a contact's sample hangs on centres and radii.
#pragma once

#include "modules/muscle/asset/collision/collision_asset.hpp"
#include "modules/muscle/kernels/collision/collision_work.hpp"

namespace fascicle::muscle {

// The way that the surface looks at a sample, in the plane of the section that is nearer (unit): out of the muscle.
glm::vec3 sample_normal(const CollisionAsset& asset, const CollisionWork& work, std::uint32_t row,
                        std::uint32_t sample);

// Fills the sample's part of a contact with its normal set: place, sections, weights, levers. False where nothing that
// carries it can move.
bool carry_sample(const CollisionAsset& asset, const CollisionWork& work, std::uint32_t row, std::uint32_t sample,
                  Contact& contact);

// The other muscle's part: the point on edge (edge, edge + 1), at `fraction` along it, `along` between the sections.
void carry_outline(const CollisionAsset& asset, const CollisionWork& work, std::uint32_t section, float along,
                   std::uint32_t edge, float fraction, Contact& contact);

// Where the sample is now (m, world).
glm::vec3 sample_place(const Contact& contact, const CollisionWork& work);

// Gives the sample's side another normal.
void turn_contact(const CollisionWork& work, const glm::vec3& normal, Contact& contact);

// Works out the constraint's mass; false where nothing can move.
bool weigh_contact(const CollisionWork& work, Contact& contact);

// Weighs it and keeps it, where there is room and something can move.
void add_contact(Contact& contact, CollisionWork& work);

}  // namespace fascicle::muscle
