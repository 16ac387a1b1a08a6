// Sections -> the drawn surface: positions (1.3), normals, the tendon sections C_t (1.4) and the cap centres.
//
// Normals are central differences: around the section, e = c_{i+1} - c_{i-1}, and along the muscle,
// d = c^{k+1} - c^{k-1} (one-sided at the ends); n = e x d points outwards. A tendon section interpolates the vertices
// and the differences of the two sections beside it, so it lies on the drawn surface, and sections' own differences
// skip it, so the shading does not change as a tendon's end passes by. Where a normal vanishes (radii of zero) it is
// the radial direction.
//
// A muscle is written in one pass, front to back: a window of four rows of vertices stays in the first-level cache.
// For the kernels' source files only (see engine/math/wide_float.hpp).
#pragma once

#include "engine/math/wide_float.hpp"
#include "modules/muscle/kernels/section_rows.hpp"

namespace fascicle::muscle::FASCICLE_ISA {

// Squared length (m^4) below which a normal has no direction.
inline constexpr float kSmallestNormalSquared = 1.0e-34f;

// 10:10:10:2 signed, from components of length 511: added up with a bias that keeps each field positive, so that no
// sign spills into the next, and which is then taken off by flipping each field's highest bit.
template <int N>
FASCICLE_INLINE WideFloat<N> pack_normal(WideVector<N> n) {
  const WideInt<N> bias = broadcast_int<N>(512 | 512 << 10 | 512 << 20);
  const WideInt<N> sum =
      round_to_int(n.x) + shift_left(round_to_int(n.y), 10) + shift_left(round_to_int(n.z), 20) + bias;
  return from_bits(sum ^ bias);
}

// Writes vertices i.. of one drawn row, from positions c and differences e, d.
template <bool kStream, int N>
FASCICLE_INLINE void write_vertices(WideVector<N> c, WideVector<N> e, WideVector<N> d, const SectionFrame& frame,
                                    const Circle& circle, std::size_t i, std::size_t count, float* to) {
  WideVector<N> normal = cross(e, d);
  WideFloat<N> squared = dot(normal, normal);
  const WideInt<N> vanished = squared < broadcast<N>(kSmallestNormalSquared);
  if (any(vanished)) [[unlikely]] {
    normal = select(vanished, radial_direction<N>(frame, circle, i), normal);
    squared = dot(normal, normal);
  }
  const WideFloat<N> packed = pack_normal((broadcast<N>(511.0f) / square_root(squared)) * normal);
  float* vertex = to + kFloatsPerVertex * i;
  if (count == N) {
    store_records<kStream>(c.x, c.y, c.z, packed, vertex);
  } else {
    alignas(64) float records[kFloatsPerVertex * N];
    store_records<false>(c.x, c.y, c.z, packed, records);
    for (std::size_t n = 0; n < count; ++n) {
      store_four(vertex + 4 * n, load<4>(records + 4 * n).v, kStream);
    }
  }
}

// A cap centre.
template <bool kStream>
FASCICLE_INLINE void write_centre(const SectionFrame& f, float sign, float* to) {
  const WideVector<4> normal{broadcast<4>(511.0f * sign * (f.uy * f.vz - f.uz * f.vy)),
                             broadcast<4>(511.0f * sign * (f.uz * f.vx - f.ux * f.vz)),
                             broadcast<4>(511.0f * sign * (f.ux * f.vy - f.uy * f.vx))};
  const WideFloat<4> packed = pack_normal(normal);
  store_four(to, _mm_setr_ps(f.ax, f.ay, f.az, packed.v[0]), kStream);
}

template <bool kStream, bool kEight>
inline void write_muscle(const SectionsView& view, std::uint32_t muscle, SectionRow* window, float* vertices) {
  const SectionLayout& layout = view.layouts[muscle];
  const std::size_t count = layout.section_vertices;
  const std::uint32_t last = layout.section_count - 1;
  const Circle circle = view.circles[layout.circle];
  float* to = vertices + kFloatsPerVertex * std::size_t{layout.first_vertex};
  const std::size_t row_floats = kFloatsPerVertex * count;
  const auto row = [&](std::uint32_t k) __attribute__((always_inline)) -> SectionRow& { return window[k & 3]; };

  make_row<kEight>(view, layout, 0, row(0));
  make_row<kEight>(view, layout, 1, row(1));
  for (std::uint32_t k = 0; k <= last; ++k) {
    if (k + 2 <= last) make_row<kEight>(view, layout, k + 2, row(k + 2));
    const SectionFrame frame = load_frame(view, layout, k);
    const SectionRow& before = row(k == 0 ? 0 : k - 1);
    const SectionRow& here = row(k);
    const SectionRow& next = row(k == last ? last : k + 1);
    for_lanes<kEight>(count, [&](auto lanes, std::size_t i, std::size_t n) __attribute__((always_inline)) {
      constexpr int N = decltype(lanes)::kCount;
      write_vertices<kStream, N>(load_vertices<N>(here, i), load_differences<kEight, N>(here, i),
                                 load_vertices<N>(next, i) - load_vertices<N>(before, i), frame, circle, i, n, to);
    });
    to += row_floats;

    for (int end = 0; end < 2; ++end) {
      if (!layout.tendon_drawn[end] || view.segment[end][layout.lane_index] != static_cast<int>(k)) continue;
      const float fraction = view.fraction[end][layout.lane_index];
      const SectionRow& after = row(k + 1 == last ? last : k + 2);
      for_lanes<kEight>(count, [&](auto lanes, std::size_t i, std::size_t n) __attribute__((always_inline)) {
        constexpr int N = decltype(lanes)::kCount;
        const WideFloat<N> s = broadcast<N>(fraction);
        const auto between = [&](WideVector<N> a, WideVector<N> b) __attribute__((always_inline)) {
          return a + s * (b - a);
        };
        const WideVector<N> c_here = load_vertices<N>(here, i), c_next = load_vertices<N>(next, i);
        const WideVector<N> d_here = c_next - load_vertices<N>(before, i);
        const WideVector<N> d_next = load_vertices<N>(after, i) - c_here;
        write_vertices<kStream, N>(between(c_here, c_next),
                                   between(load_differences<kEight, N>(here, i), load_differences<kEight, N>(next, i)),
                                   between(d_here, d_next), frame, circle, i, n, to);
      });
      to += row_floats;
    }
  }
  write_centre<kStream>(load_frame(view, layout, 0), -1.0f, to);
  write_centre<kStream>(load_frame(view, layout, last), 1.0f, to + kFloatsPerVertex);
}

// A detached muscle: all vertices at its origin.
inline void collapse_muscle(const SectionsView& view, std::uint32_t muscle, float* vertices) {
  const SectionLayout& layout = view.layouts[muscle];
  SectionFrame frame = load_frame(view, layout, 0);
  float* to = vertices + kFloatsPerVertex * std::size_t{layout.first_vertex};
  for (std::uint32_t i = 0; i < layout.vertex_count; ++i) write_centre<false>(frame, -1.0f, to + kFloatsPerVertex * i);
}

template <bool kStream>
inline void write_all(const WriteSurfacesJob& job) {
  SectionRow window[4];
  for (SectionRow& row : window) {  // lanes beyond a row's end are computed, if not written: keep them numbers
    __builtin_memset(&row, 0, sizeof(row));
  }
  const SectionsView& view = job.sections;
  for (std::uint32_t muscle = 0; muscle < view.muscle_count; ++muscle) {
    if (view.attached != nullptr && view.attached[muscle] == 0) collapse_muscle(view, muscle, job.vertices);
    else if (view.layouts[muscle].section_vertices == 8) write_muscle<kStream, true>(view, muscle, window, job.vertices);
    else write_muscle<kStream, false>(view, muscle, window, job.vertices);
  }
}

inline void write_surfaces(const WriteSurfacesJob& job) {
  if (job.stream) {
    write_all<true>(job);
    _mm_sfence();
  } else {
    write_all<false>(job);
  }
}

}  // namespace fascicle::muscle::FASCICLE_ISA
