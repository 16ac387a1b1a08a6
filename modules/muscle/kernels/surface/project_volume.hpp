// The volume (4.1) as one constraint of the whole mesh, by its vertices' rings (asset/surface/vertex_rings.hpp): four
// vertices side by side, a record each, so that neither a gather nor a scatter takes records apart. Every vertex' ring
// gives its gradient g, and six times the volume is a third of the sum of p . g. Sums run over the 16 floats of four
// vertices on all instruction sets, from chunk to chunk in double.
// For the kernels' source files only (see engine/math/wide_float.hpp).
#pragma once

#include "engine/math/wide_float.hpp"
#include "modules/muscle/kernels/surface/surface_kernel_data.hpp"
#include "modules/muscle/kernels/surface/vertex_fours.hpp"

namespace fascicle::muscle::FASCICLE_ISA {

inline constexpr std::size_t kChunkFours = 64;  // how many numbers are added in float

// Adds the four lanes' x, y and z; w's are zero.
FASCICLE_INLINE double sum_lanes(WideFloat<16> a) {
  float lanes[16];
  store(a, lanes);
  double sum = 0.0;
  for (int i = 0; i < 16; ++i) sum += static_cast<double>(lanes[i]);
  return sum;
}

FASCICLE_INLINE WideFloat<16> load_row(const float* points, const std::int32_t* row) {
  return join_records(points + 4 * static_cast<long>(row[0]), points + 4 * static_cast<long>(row[1]),
                      points + 4 * static_cast<long>(row[2]), points + 4 * static_cast<long>(row[3]));
}

// The sum of p_k x p_{k+1} round four vertices' rings, w zero.
FASCICLE_INLINE WideFloat<16> walk_rings(const VolumeRows& rows, std::size_t four, const float* points,
                                         WideFloat<16> origin) {
  WideFloat<16> sum = broadcast<16>(0.0f);  // one turn of the axes behind
  WideFloat<16> here = load_row(points, rows.rings + 4 * rows.first_ring[four]) - origin;
  WideFloat<16> turned = reorder<kYzxw>(here);
  for (std::uint32_t r = rows.first_ring[four] + 1; r < rows.first_ring[four + 1]; ++r) {
    const WideFloat<16> next = load_row(points, rows.rings + 4 * r) - origin;
    const WideFloat<16> next_turned = reorder<kYzxw>(next);
    sum = sum + (here * next_turned - next * turned);
    here = next;
    turned = next_turned;
  }
  return reorder<kYzxw>(sum);
}

struct VolumeSums {
  double volume = 0.0;  // m^3, six times
  double square = 0.0;  // m^4/kg: of w g^2
};

template <bool kKeepGradient>
FASCICLE_INLINE VolumeSums sum_volume(const VolumeRows& rows) {
  const float* points = reinterpret_cast<const float*>(rows.points);
  float* gradients = reinterpret_cast<float*>(rows.gradient);
  const WideFloat<16> origin = repeat_record<16>(points);
  const std::size_t fours = (rows.vertex_count + 3) / 4;
  VolumeSums sums;
  for (std::size_t begin = 0; begin < fours; begin += kChunkFours) {
    const std::size_t end = begin + kChunkFours < fours ? begin + kChunkFours : fours;
    WideFloat<16> volume = broadcast<16>(0.0f), square = broadcast<16>(0.0f);
    for (std::size_t four = begin; four < end; ++four) {
      const WideFloat<16> g = walk_rings(rows, four, points, origin);
      const WideFloat<16> p = load_vertices(points, four, rows.vertex_count);
      volume = volume + (p - origin) * g;
      if constexpr (kKeepGradient) {
        square = square + (reorder<kAllW>(p) * g) * g;
        store_vertices(g, gradients, four, rows.vertex_count);
      }
    }
    sums.volume += sum_lanes(volume);
    if constexpr (kKeepGradient) sums.square += sum_lanes(square);
  }
  sums.volume /= 3.0;
  return sums;
}

inline double measure_volume(const VolumeRows& rows) { return sum_volume<false>(rows).volume; }

inline double project_volume(const VolumeRows& rows) {
  const VolumeSums sums = sum_volume<true>(rows);
  const double sum = sums.square + static_cast<double>(rows.compliance);
  const double error = sums.volume - rows.rest;
  if (!(sums.square > 0.0) || error == 0.0) return sums.volume;
  const WideFloat<16> lambda = broadcast<16>(static_cast<float>(-error / sum));
  float* points = reinterpret_cast<float*>(rows.points);
  const float* gradients = reinterpret_cast<const float*>(rows.gradient);
  for (std::size_t i = 0; i < (rows.vertex_count + 3) / 4; ++i) {
    const WideFloat<16> p = load_vertices(points, i, rows.vertex_count);
    const WideFloat<16> g = load_vertices(gradients, i, rows.vertex_count);
    store_vertices(p + (reorder<kAllW>(p) * lambda) * g, points, i, rows.vertex_count);
  }
  return sums.volume;
}

}  // namespace fascicle::muscle::FASCICLE_ISA
