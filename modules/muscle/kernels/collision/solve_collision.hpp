// The solve in reduced coordinates: centres a_k and radii r_i^k, nothing else moves (method 3.4).
//
// It is position based dynamics without inertia. A step starts from where the last one ended, carried along by the
// bones. In each substep what is displaced relaxes towards the shape that the bones give it, by implicit Euler with a
// time constant a kind (its compliance); then contacts are found, and a few rounds of Gauss-Seidel satisfy them with
// accumulated, non-negative multipliers while sections are held at their area. Without velocities nothing can ring or
// explode, the same pose gives the same rest, and what is pressed comes back as soon as it is free.
#pragma once

#include <span>

#include <glm/mat4x4.hpp>

#include "modules/muscle/asset/collision/collision_asset.hpp"
#include "modules/muscle/kernels/collision/collision_work.hpp"

namespace fascicle::muscle {

// `step` in s; nothing happens in none. a, driven, radii, wanted, area_target, mobility and frames must be set. Afterwards
// `contacts` are the last substep's.
void solve_collision(const CollisionAsset& asset, const CollisionSettings& settings, std::span<const glm::mat4> bones,
                     float step, CollisionWork& work);

// The parts.
void relax_shape(const CollisionAsset& asset, const CollisionSettings& settings, float step, CollisionWork& work);
void find_contacts(const CollisionAsset& asset, const CollisionSettings& settings, std::span<const glm::mat4> bones,
                   CollisionWork& work, bool at_rest = false);
void begin_substep(const CollisionAsset& asset, const CollisionSettings& settings, std::span<const glm::mat4> bones,
                   bool refresh, CollisionWork& work);
void project_contacts(CollisionWork& work);
void hold_areas(const CollisionAsset& asset, CollisionWork& work);

// C as it is now.
float contact_value(const Contact& contact, const CollisionWork& work);

}  // namespace fascicle::muscle
