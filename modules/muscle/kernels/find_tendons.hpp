// Where the tendons end on the lines as they are now (1.4). The free tendon's length is walked from its bone along the
// arc length; a tendon longer than the line is clamped, the insertion's to the origin, the origin's to the
// insertion's.
// For the kernels' source files only (see engine/math/wide_float.hpp).
#pragma once

#include "engine/math/wide_float.hpp"
#include "modules/muscle/kernels/mtu_kernels.hpp"

namespace fascicle::muscle::FASCICLE_ISA {

using namespace fascicle::FASCICLE_ISA;

inline void find_tendons(const FindTendonsJob& job) {
  constexpr int N = kLanes;
  using Float = WideFloat<N>;
  const Float zero = broadcast<N>(0.0f), one = broadcast<N>(1.0f);
  for (std::size_t block_index = 0; block_index < job.block_count; ++block_index) {
    const LaneBlock& block = job.blocks[block_index];
    if (block.height < 2) continue;
    const std::size_t lane = block_index * kLanes;
    const float* arcs = job.arc + block.first_slot;
    const WideInt<N> counts = load_int<N>(block.counts);
    const Float total = load<N>(arcs + kLanes * std::size_t{block.height - 1});
    const Float insertion = maximum(zero, total - load<N>(job.insertion_lengths + lane));
    const Float borders[2] = {minimum(load<N>(job.origin_lengths + lane), insertion), insertion};
    for (int end = 0; end < 2; ++end) {
      WideInt<N> segment = broadcast_int<N>(0);
      Float from = zero, to = load<N>(arcs + kLanes);
      for (std::uint32_t k = 1; k + 1 < block.height; ++k) {
        const Float arc = load<N>(arcs + kLanes * std::size_t{k});
        const WideInt<N> reached = (arc <= borders[end]) & (broadcast_int<N>(static_cast<int>(k + 1)) < counts);
        segment = select(reached, broadcast_int<N>(static_cast<int>(k)), segment);
        from = select(reached, arc, from);
        to = select(reached, load<N>(arcs + kLanes * std::size_t{k + 1}), to);
      }
      const Float length = to - from;
      const WideInt<N> has_length = zero < length;
      const Float fraction = select(has_length, (borders[end] - from) / select(has_length, length, one), zero);
      store_int(segment, job.segment[end] + lane);
      store(minimum(maximum(fraction, zero), one), job.fraction[end] + lane);
      store(borders[end], job.border_arc[end] + lane);
    }
  }
}

}  // namespace fascicle::muscle::FASCICLE_ISA
