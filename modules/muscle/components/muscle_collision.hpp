// State: how far collision has deformed a musculature, and what touches what. On a musculature's entity, where its
// character has collision.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include <glm/vec3.hpp>

#include "engine/math/aligned_vector.hpp"
#include "modules/muscle/asset/collision/collision_description.hpp"

namespace fascicle::muscle {

struct CollisionAsset;

struct MuscleCollision {
  CollisionSettings settings;  // may be changed at any time
  // By level of detail, as MuscleLevels::assets.
  std::vector<std::shared_ptr<const CollisionAsset>> levels;

  // By slot: m, what collision has moved a_k by from where its bones carry it, in the frame of the bone that carries
  // most of it.
  AlignedVector<float> offset_x, offset_y, offset_z;
  AlignedVector<float> rest_radii;    // m, by MuscleAsset::radius: the shape that radii come back to
  std::vector<float> target_area;     // m^2, by MuscleAsset's sections: what the section's area is held at
  std::vector<float> area;            // m^2: what it is after the solve
  std::vector<float> depth;           // m, by muscle: its deepest penetration left by the solve, beyond rest
  std::uint64_t fallbacks = 0;        // muscle steps that fell back to the skinned rest shape, since the spawn
  std::uint32_t teleport_count = 0;
};

// What a muscle touches: another muscle or a bone.
struct MuscleContact {
  std::uint32_t muscle = 0;
  std::int32_t bone = -1;          // >= 0: a bone, else
  std::uint32_t other = 0;         // a muscle of the same musculature, with a higher index
  std::uint32_t points = 0;        // of the surfaces that touch
  float depth = 0.0f;              // m: how deep they would be in each other without the solve
  float left = 0.0f;               // m: what the solve left of it, beyond what there is at rest
  glm::vec3 place{0.0f};           // m, world: of the deepest point
  glm::vec3 normal{0.0f};          // unit, world: away from the other
};

// On the same entity: read by games. Room for all is made at the spawn.
struct MuscleContacts {
  std::vector<MuscleContact> now;    // by muscle, then bone or other muscle
  std::vector<MuscleContact> began;  // those of `now` that were not there a step ago
  std::vector<MuscleContact> ended;  // those that were and are no more, as they were
  bool overflow = false;             // more than there is room for: the shallowest were left out
};

std::size_t heap_bytes(const MuscleCollision& collision);
std::size_t heap_bytes(const MuscleContacts& contacts);

}  // namespace fascicle::muscle
