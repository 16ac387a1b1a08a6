// Bones -> points of the action lines (1.1): x = (1-s) T_i p_i + s T_j p_j, the weights already multiplied in. A point
// is at most two rigid transforms; one bone's column is one 4-wide register.
// For the kernels' source files only (see engine/math/wide_float.hpp).
#pragma once

#include "engine/math/wide_float.hpp"
#include "modules/muscle/kernels/mtu_kernels.hpp"

namespace fascicle::muscle::FASCICLE_ISA {

using namespace fascicle::FASCICLE_ISA;

// Sum of the columns of matrix `m` by the weights `p`; with p[3] = 0 it turns a direction.
FASCICLE_INLINE WideFloat<4> transform(const float* m, const float* p) {
  return p[0] * load<4>(m) + p[1] * load<4>(m + 4) + p[2] * load<4>(m + 8) + p[3] * load<4>(m + 12);
}

inline bool check_bones(const float* bones, std::size_t count) {
  const WideFloat<8> largest = broadcast<8>(kLargestBoneEntry);
  WideInt<8> good = broadcast_int<8>(-1);
  for (std::size_t i = 0; i < 16 * count; i += 8) good = good & (absolute(load<8>(bones + i)) <= largest);
  return !any(good ^ broadcast_int<8>(-1));
}

// A point whose binding is on its way to another one's is at the same part of the way between their points, since
// a point is linear in its binding.
template <bool kMorph>
inline void place_all(const PlacePointsJob& job) {
  // Column sums by the weights at `from`, or by those between them and `to`.
  const auto carry_by = [&](std::uint32_t bone, const float* from, const float* to) __attribute__((always_inline)) {
    if constexpr (!kMorph) return transform(job.bones + 16 * bone, from);
    alignas(16) float mixed[4];
    const WideFloat<4> start = load<4>(from);
    store(start + job.morph * (load<4>(to) - start), mixed);
    return transform(job.bones + 16 * bone, mixed);
  };
  const auto place = [&](const PointBinding& point, WideFloat<4> at) __attribute__((always_inline)) {
    job.x[point.slot] = at.v[0];
    job.y[point.slot] = at.v[1];
    job.z[point.slot] = at.v[2];
  };
  const auto is_held = [&](const PointBinding& point) __attribute__((always_inline)) {
    return job.held != nullptr && job.held[point.muscle] != 0;
  };
  for (std::size_t i = 0; i < job.single_count; ++i) {
    const PointBinding& point = job.points[i];
    const PointBinding& target = kMorph ? job.targets[i] : point;
    if (is_held(point)) continue;
    place(point, carry_by(point.first_bone, point.first, target.first));
  }
  for (std::size_t i = job.single_count; i < job.count; ++i) {
    const PointBinding& point = job.points[i];
    const PointBinding& target = kMorph ? job.targets[i] : point;
    if (is_held(point)) continue;
    place(point, carry_by(point.first_bone, point.first, target.first) +
                     carry_by(point.second_bone, point.second, target.second));
  }
}

inline void place_points(const PlacePointsJob& job) {
  if (job.targets == nullptr) place_all<false>(job);
  else place_all<true>(job);
}

}  // namespace fascicle::muscle::FASCICLE_ISA
