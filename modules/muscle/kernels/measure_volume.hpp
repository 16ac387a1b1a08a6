// The belly's volume (1.6), between the tendons' borders. Every segment's |C| prisms fall into 3 |C| tetrahedra; seen
// from a, with b_i = c_i - a, b'_i = c'_i - a', D = a' - a and w_i = D + b'_i, six times their volumes are
//
//   (a, a', c'_i, c'_{i+1})         D . (w_i x w_{i+1})        = D . (b'_i x b'_{i+1})
//   (a, c_i, c_{i+1}, c'_{i+1})     b_i . (b_{i+1} x w_{i+1})
//   (a, c_i, c'_{i+1}, c'_i)        b_i . (w_{i+1} x w_i)
//
// of which the last two are together b_i . (w_{i+1} x (w_i - b_{i+1})). They are summed with their signs. Where all are
// positive that is the method's sum of absolute values; where a_k lies outside its slice (page 2's negative radii) or a
// bend folds sections over each other, it is still the volume that the surface encloses, which the sum of absolute
// values is not.
//
// Eight prisms side by side go down the muscle together, one section after the other, in registers alone. Lanes are
// fixed at 8 on every instruction set, since the order of summation depends on their number.
// For the kernels' source files only (see engine/math/wide_float.hpp).
#pragma once

#include "engine/math/wide_float.hpp"
#include "modules/muscle/kernels/section_rows.hpp"

namespace fascicle::muscle::FASCICLE_ISA {

// Eight vertices of a section and those after them, as seen from its centre.
struct Edge {
  WideVector<8> here, next;
  float ax, ay, az;
};

FASCICLE_INLINE Edge make_edge(const SectionsView& view, const SectionLayout& layout, std::uint32_t k,
                               std::uint32_t i) {
  const SectionFrame frame = load_frame(view, layout, k);
  const Circle circle = view.circles[layout.circle];
  const float* radii = radii_of(view, layout, k);
  const WideFloat<8> r = load<8>(radii + i), after = radii_after<8>(radii, i, layout.section_vertices);
  return {in_plane(frame, r * load<8>(circle.cosines + i), r * load<8>(circle.sines + i)),
          in_plane(frame, after * load<8>(circle.cosines + i + 1), after * load<8>(circle.sines + i + 1)),
          frame.ax, frame.ay, frame.az};
}

FASCICLE_INLINE Edge interpolate(const Edge& a, const Edge& b, float fraction) {
  const WideFloat<8> s = broadcast<8>(fraction);
  return {a.here + s * (b.here - a.here), a.next + s * (b.next - a.next), a.ax + fraction * (b.ax - a.ax),
          a.ay + fraction * (b.ay - a.ay), a.az + fraction * (b.az - a.az)};
}

// Six times the prisms' volumes.
FASCICLE_INLINE WideFloat<8> measure_prisms(const Edge& from, const Edge& to) {
  const WideVector<8> step{broadcast<8>(to.ax - from.ax), broadcast<8>(to.ay - from.ay),
                           broadcast<8>(to.az - from.az)};
  const WideVector<8> w = step + to.here, w_next = step + to.next;
  return dot(step, cross(to.here, to.next)) + dot(from.here, cross(w_next, w - from.next));
}

inline void measure_volume(const MeasureVolumeJob& job) {
  const SectionsView& view = job.sections;
  for (std::uint32_t muscle = 0; muscle < view.muscle_count; ++muscle) {
    job.volumes[muscle] = 0.0f;
    if (view.attached != nullptr && view.attached[muscle] == 0) continue;
    const SectionLayout& layout = view.layouts[muscle];
    const std::uint32_t first = static_cast<std::uint32_t>(view.segment[0][layout.lane_index]);
    const std::uint32_t last = static_cast<std::uint32_t>(view.segment[1][layout.lane_index]);
    const float start = view.fraction[0][layout.lane_index], end = view.fraction[1][layout.lane_index];
    WideFloat<8> sum = broadcast<8>(0.0f);
    for (std::uint32_t i = 0; i < layout.section_vertices; i += 8) {
      WideFloat<8> six_volumes = broadcast<8>(0.0f);
      Edge here = make_edge(view, layout, first, i);
      for (std::uint32_t k = first; k <= last; ++k) {
        const Edge next = make_edge(view, layout, k + 1, i);
        const Edge from = k == first ? interpolate(here, next, start) : here;
        const Edge to = k == last ? interpolate(here, next, end) : next;
        six_volumes = six_volumes + measure_prisms(from, to);
        here = next;
      }
      const WideInt<8> inside =
          load_int<8>(kLaneNumbers) < broadcast_int<8>(static_cast<int>(layout.section_vertices - i));
      sum = sum + select(inside, six_volumes, broadcast<8>(0.0f));
    }
    const float volume = sum_in_order(sum) / 6.0f;
    job.volumes[muscle] = volume > 0.0f ? volume : 0.0f;
  }
}

}  // namespace fascicle::muscle::FASCICLE_ISA
