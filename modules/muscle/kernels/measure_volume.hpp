// The belly's volume (1.6), between the tendons' borders. Every segment's |C| prisms fall into 3 |C| tetrahedra; seen
// from a, with b_i = c_i - a, b'_i = c'_i - a', D = a' - a and w_i = D + b'_i, six times their volumes are
//
//   (a, a', c'_i, c'_{i+1})         D . (w_i x w_{i+1})        = D . (b'_i x b'_{i+1})
//   (a, c_i, c_{i+1}, c'_{i+1})     b_i . (b_{i+1} x w_{i+1})
//   (a, c_i, c'_{i+1}, c'_i)        b_i . (w_{i+1} x w_i)
//
// They are summed with their signs. Where all are positive that is the method's sum of absolute values; where a_k lies
// outside its slice (page 2's negative radii) or a bend folds sections over each other, it is still the volume that
// the surface encloses, which the sum of absolute values is not.
//
// Lanes are fixed at 8 on every instruction set, since the order of summation depends on their number.
// For the kernels' source files only (see engine/math/wide_float.hpp).
#pragma once

#include "engine/math/wide_float.hpp"
#include "modules/muscle/kernels/section_rows.hpp"

namespace fascicle::muscle::FASCICLE_ISA {

struct CentredRow {
  SectionRow around;  // relative to the centre
  float ax, ay, az;
};

FASCICLE_INLINE void make_centred_row(const SectionsView& view, const SectionLayout& layout, std::uint32_t k,
                                      CentredRow& row) {
  make_row<true>(view, layout, k, row.around);
  const std::size_t slot = layout.first_slot + std::size_t{kLanes} * k;
  row.ax = view.x[slot];
  row.ay = view.y[slot];
  row.az = view.z[slot];
}

// from + fraction (to - from), into `from`.
FASCICLE_INLINE void interpolate_row(const CentredRow& to, float fraction, std::uint32_t count, CentredRow& from) {
  const WideFloat<8> s = broadcast<8>(fraction);
  for (std::uint32_t i = 0; i < count; i += 8) {
    const WideVector<8> a = load_row<8>(from.around, i), b = load_row<8>(to.around, i);
    store_row(a + s * (b - a), i, from.around);
  }
  close_row(count, from.around);
  from.ax += fraction * (to.ax - from.ax);
  from.ay += fraction * (to.ay - from.ay);
  from.az += fraction * (to.az - from.az);
}

// Six times the volume between two rows, by lane.
FASCICLE_INLINE WideFloat<8> measure_segment(const CentredRow& from, const CentredRow& to, std::uint32_t count) {
  alignas(32) static constexpr int kLaneNumbers[8] = {0, 1, 2, 3, 4, 5, 6, 7};
  const WideInt<8> lane = load_int<8>(kLaneNumbers);
  const WideVector<8> step{broadcast<8>(to.ax - from.ax), broadcast<8>(to.ay - from.ay),
                           broadcast<8>(to.az - from.az)};
  WideFloat<8> sum = broadcast<8>(0.0f);
  for (std::uint32_t i = 0; i < count; i += 8) {
    const WideVector<8> b = load_row<8>(from.around, i), b_next = load_row<8>(from.around, i, 1);
    const WideVector<8> c = load_row<8>(to.around, i), c_next = load_row<8>(to.around, i, 1);
    const WideVector<8> w = step + c, w_next = step + c_next;
    const WideFloat<8> six_volumes =
        dot(step, cross(c, c_next)) + dot(b, cross(b_next, w_next)) + dot(b, cross(w_next, w));
    const WideInt<8> inside = lane < broadcast_int<8>(static_cast<int>(count - i));
    sum = sum + select(inside, six_volumes, broadcast<8>(0.0f));
  }
  return sum;
}

inline void measure_volume(const MeasureVolumeJob& job) {
  CentredRow rows[2];
  __builtin_memset(rows, 0, sizeof(rows));  // lanes beyond a row's end are computed, if not counted
  const SectionsView& view = job.sections;
  for (std::uint32_t muscle = 0; muscle < view.muscle_count; ++muscle) {
    job.volumes[muscle] = 0.0f;
    if (view.attached != nullptr && view.attached[muscle] == 0) continue;
    const SectionLayout& layout = view.layouts[muscle];
    const std::uint32_t count = layout.section_vertices;
    const std::uint32_t first = static_cast<std::uint32_t>(view.segment[0][layout.lane_index]);
    const std::uint32_t last = static_cast<std::uint32_t>(view.segment[1][layout.lane_index]);
    CentredRow *from = &rows[0], *to = &rows[1];
    make_centred_row(view, layout, first, *from);
    make_centred_row(view, layout, first + 1, *to);
    // The insertion's border may lie in the same segment: its row is then made from the whole segment too.
    CentredRow* const start = from;
    WideFloat<8> sum = broadcast<8>(0.0f);
    const float start_fraction = view.fraction[0][layout.lane_index];
    const float end_fraction = view.fraction[1][layout.lane_index];
    if (first == last) {
      const float rest = start_fraction < 1.0f ? (end_fraction - start_fraction) / (1.0f - start_fraction) : 0.0f;
      interpolate_row(*to, start_fraction, count, *start);
      // to <- start + rest (to - start), written as to + (1 - rest) (start - to).
      interpolate_row(*start, 1.0f - rest, count, *to);
      sum = measure_segment(*start, *to, count);
    } else {
      interpolate_row(*to, start_fraction, count, *start);
      sum = measure_segment(*start, *to, count);
      for (std::uint32_t k = first + 1; k <= last; ++k) {
        CentredRow* const next = from;
        from = to;
        to = next;
        make_centred_row(view, layout, k + 1, *to);
        if (k == last) interpolate_row(*from, 1.0f - end_fraction, count, *to);
        sum = sum + measure_segment(*from, *to, count);
      }
    }
    const float volume = sum_in_order(sum) / 6.0f;
    job.volumes[muscle] = volume > 0.0f ? volume : 0.0f;
  }
}

}  // namespace fascicle::muscle::FASCICLE_ISA
