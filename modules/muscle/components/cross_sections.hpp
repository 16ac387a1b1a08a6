// State: the cross sections' frames (1.2) and algebraic radii (1.3). On a musculature's entity.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "engine/math/aligned_vector.hpp"
#include "modules/muscle/kernels/kernel_data.hpp"

namespace fascicle::muscle {

struct CrossSections {
  // By slot: in-plane unit directions; the section's normal is t = u x v.
  AlignedVector<float> ux, uy, uz, vx, vy, vz;
  AlignedVector<float> arc;    // by slot: m along the drawn line from the origin
  AlignedVector<float> radii;  // m; by MuscleAsset::radius; may be negative
  AlignedVector<float> twist;  // by lane: rad, at the insertion, unwrapped, zero at rest
  // Like MuscleAsset::ends, in place of them while a level of detail is on its way to another (Musculature::morph).
  std::vector<EndFrame> ends;
  std::uint32_t teleport_count = 0;  // of the bones when the twist was last followed
  bool fresh = true;                 // not yet followed at all
};

std::size_t heap_bytes(const CrossSections& sections);

}  // namespace fascicle::muscle
