// State: how far collision has deformed a musculature, and what touches what. On a musculature's entity, where its
// muscles collide (add_collision).
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

#include "engine/math/aligned_vector.hpp"
#include "modules/muscle/asset/collision/collision_description.hpp"

namespace fascicle::muscle {

struct CollisionAsset;
struct MuscleAsset;

struct MuscleCollision {
  CollisionSettings settings;  // may be changed between steps
  std::vector<std::shared_ptr<const CollisionAsset>> levels;  // by level of detail, as MuscleLevels::assets

  // The deformation, in the order of the asset that it was last carried to.
  const CollisionAsset* asset = nullptr;
  AlignedVector<float> offset_x, offset_y, offset_z;  // by slot: m, what a_k is moved by, in its bone's frame
  AlignedVector<float> radii;                         // m, by MuscleAsset::radius
  AlignedVector<float> rest_radii;                    // m: the shape that they come back to
  float morph = 0.0f;                                 // that rest_radii are for
  // How long the pose and the settings have been the same, and which these are: bone to the first one's frame. What
  // else changes a muscle's rest sets `still` to 0.
  float still = 0.0f;  // s
  std::vector<glm::mat4> pose;
  CollisionSettings solved;
  AlignedVector<float> carried[4];                    // scratch of a change of level

  // Written by the solve, for measuring; by CollisionAsset::sections.
  std::vector<float> target_area;  // m^2: what the section's area is held at
  std::vector<float> area;         // m^2: what it is
  std::vector<float> depth;        // m, by muscle: how deep the solve left it in anything, beyond what it is at rest
  std::vector<float> cost;         // by muscle: contacts it took part in
  std::uint64_t fallbacks = 0;     // muscle steps that fell back to the skinned rest shape, since the spawn
  std::uint64_t overflows = 0;     // steps in which there were more contacts than there is room for
  std::uint32_t contact_count = 0;  // of the last substep
};

// What a muscle touches: another muscle or a bone.
struct MuscleContact {
  std::uint32_t muscle = 0;
  std::int32_t bone = -1;          // >= 0: a bone, else
  std::uint32_t other = 0;         // a muscle of the same musculature, with a higher index
  std::uint32_t points = 0;        // of the surfaces that touch
  float depth = 0.0f;              // m: how deep the step pressed them into each other, before the solve
  float left = 0.0f;               // m: what the solve left of it; both beyond what there is at rest
  glm::vec3 place{0.0f};           // m, world: of the deepest point
  glm::vec3 normal{0.0f};          // unit, world: out of the other
};

// On the same entity: read by games. Room for all is made at the spawn.
struct MuscleContacts {
  std::vector<MuscleContact> now;    // by muscle, then bones, then other muscles
  std::vector<MuscleContact> began;  // those of `now` that were not there a step ago
  std::vector<MuscleContact> ended;  // those that were and are no more, as they were
  std::vector<MuscleContact> gone;   // scratch
};

std::size_t heap_bytes(const MuscleCollision& collision);
std::size_t heap_bytes(const MuscleContacts& contacts);

}  // namespace fascicle::muscle
