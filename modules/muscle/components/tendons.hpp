// State: where the tendons end on the current action lines (1.4). On a musculature's entity.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "engine/math/aligned_vector.hpp"
#include "modules/muscle/asset/muscle_asset.hpp"

namespace fascicle::muscle {

struct Tendons {
  // By MuscleEnd, then lane. Without a tendon the border is the line's first or last point.
  std::array<AlignedVector<std::int32_t>, 2> segment;
  std::array<AlignedVector<float>, 2> fraction;
  std::array<AlignedVector<float>, 2> arc;  // m from the origin
};

LinePlace tendon_border(const MuscleAsset& asset, const Tendons& tendons, std::uint32_t muscle, MuscleEnd end);

std::size_t heap_bytes(const Tendons& tendons);

}  // namespace fascicle::muscle
