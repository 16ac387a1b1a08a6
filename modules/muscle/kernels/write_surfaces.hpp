// Sections -> the drawn surface: positions (1.3), normals, the tendon sections C_t (1.4) and the cap centres.
//
// Normals are central differences: around the section, e = c_{i+1} - c_{i-1}, and along the muscle,
// d = c^{k+1} - c^{k-1} (one-sided at the ends); n = e x d points outwards. A tendon section interpolates the vertices
// and the differences of the two sections beside it, so it lies on the drawn surface, and sections' own differences
// skip it, so the shading does not change as a tendon's end passes by. Where a normal vanishes (radii of zero) it is
// the radial direction.
//
// A muscle is written front to back: a window of four sections' vertices stays in the first-level cache.
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

// A drawn row between its two passes. Its roots and quotients take longer than all else and are of no use to any
// instruction nearby: the second pass comes a section later, when they are long done.
struct ShadedRow {
  alignas(64) float nx[kMaxSectionVertices + 16], ny[kMaxSectionVertices + 16], nz[kMaxSectionVertices + 16];
  alignas(64) float inverse[kMaxSectionVertices + 16];  // 511 / |n|
  const SectionRow* vertices = nullptr;
};

// First pass, vertices i..: normals, not yet of unit length, from the differences e and d.
template <int N>
FASCICLE_INLINE void shade_vertices(WideVector<N> e, WideVector<N> d, const SectionFrame& frame, const Circle& circle,
                                    std::size_t i, ShadedRow& row) {
  WideVector<N> normal = cross(e, d);
  WideFloat<N> squared = dot(normal, normal);
  const WideInt<N> vanished = squared < broadcast<N>(kSmallestNormalSquared);
  if (any(vanished)) [[unlikely]] {
    normal = select(vanished, radial_direction<N>(frame, circle, i), normal);
    squared = dot(normal, normal);
  }
  store(normal.x, row.nx + i);
  store(normal.y, row.ny + i);
  store(normal.z, row.nz + i);
  store(broadcast<N>(511.0f) / square_root(squared), row.inverse + i);
}

// Second pass: packs the normals and writes the row.
template <bool kStream, bool kEight>
FASCICLE_INLINE void write_row(const ShadedRow& row, std::size_t section_vertices, float* to) {
  for_lanes<kEight>(section_vertices, [&](auto lanes, std::size_t i, std::size_t count) __attribute__((always_inline)) {
    constexpr int N = decltype(lanes)::kCount;
    const WideVector<N> c = load_vertices<N>(*row.vertices, i);
    const WideVector<N> normal{load<N>(row.nx + i), load<N>(row.ny + i), load<N>(row.nz + i)};
    const WideFloat<N> packed = pack_normal(load<N>(row.inverse + i) * normal);
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
  });
}

// The rows drawn for one section: its own, and those of tendons that end in the segment behind it.
struct ShadedSection {
  ShadedRow rows[3];
  int count = 0;
};

// What a muscle is written by.
struct SurfaceScratch {
  SectionRow window[4];    // sections k - 1 to k + 2
  SectionRow tendons[2];   // vertices of the tendon sections
  ShadedSection shaded[2];
};

// A cap centre.
template <bool kStream>
FASCICLE_INLINE void write_centre(const SectionFrame& f, float sign, float* to) {
  const WideVector<4> normal{broadcast<4>(511.0f * sign * (f.uy * f.vz - f.uz * f.vy)),
                             broadcast<4>(511.0f * sign * (f.uz * f.vx - f.ux * f.vz)),
                             broadcast<4>(511.0f * sign * (f.ux * f.vy - f.uy * f.vx))};
  const WideFloat<4> packed = pack_normal(normal);
  store_four(to, _mm_setr_ps(f.ax, f.ay, f.az, packed.v[0]), kStream);
}

// First pass over section k and the tendon sections behind it.
template <bool kEight>
FASCICLE_INLINE void shade_section(const SectionsView& view, const SectionLayout& layout, std::uint32_t k,
                                   SurfaceScratch& scratch, ShadedSection& shaded) {
  const std::size_t count = layout.section_vertices;
  const std::uint32_t last = layout.section_count - 1;
  const Circle circle = view.circles[layout.circle];
  const SectionFrame frame = load_frame(view, layout, k);
  const SectionRow& before = scratch.window[(k == 0 ? 0 : k - 1) & 3];
  const SectionRow& here = scratch.window[k & 3];
  const SectionRow& next = scratch.window[(k == last ? last : k + 1) & 3];
  shaded.count = 1;
  shaded.rows[0].vertices = &here;
  for_lanes<kEight>(count, [&](auto lanes, std::size_t i, std::size_t) __attribute__((always_inline)) {
    constexpr int N = decltype(lanes)::kCount;
    shade_vertices<N>(load_differences<kEight, N>(here, i), load_vertices<N>(next, i) - load_vertices<N>(before, i),
                      frame, circle, i, shaded.rows[0]);
  });

  for (int end = 0; end < 2; ++end) {
    if (!layout.tendon_drawn[end] || view.segment[end][layout.lane_index] != static_cast<int>(k)) continue;
    const float fraction = view.fraction[end][layout.lane_index];
    const SectionRow& after = scratch.window[(k + 1 == last ? last : k + 2) & 3];
    ShadedRow& row = shaded.rows[shaded.count++];
    row.vertices = &scratch.tendons[end];
    for_lanes<kEight>(count, [&](auto lanes, std::size_t i, std::size_t) __attribute__((always_inline)) {
      constexpr int N = decltype(lanes)::kCount;
      const WideFloat<N> s = broadcast<N>(fraction);
      const auto between = [&](WideVector<N> a, WideVector<N> b) __attribute__((always_inline)) {
        return a + s * (b - a);
      };
      const WideVector<N> c_here = load_vertices<N>(here, i), c_next = load_vertices<N>(next, i);
      const WideVector<N> d_here = c_next - load_vertices<N>(before, i);
      const WideVector<N> d_next = load_vertices<N>(after, i) - c_here;
      store_vertices(between(c_here, c_next), i, scratch.tendons[end]);
      shade_vertices<N>(between(load_differences<kEight, N>(here, i), load_differences<kEight, N>(next, i)),
                        between(d_here, d_next), frame, circle, i, row);
    });
  }
}

template <bool kStream, bool kEight>
inline void write_muscle(const SectionsView& view, std::uint32_t muscle, SurfaceScratch& scratch, float* vertices) {
  const SectionLayout& layout = view.layouts[muscle];
  const std::size_t count = layout.section_vertices;
  const std::uint32_t last = layout.section_count - 1;
  float* to = vertices + kFloatsPerVertex * std::size_t{layout.first_vertex};
  const auto write_section = [&](const ShadedSection& shaded) __attribute__((always_inline)) {
    for (int i = 0; i < shaded.count; ++i) {
      write_row<kStream, kEight>(shaded.rows[i], count, to);
      to += kFloatsPerVertex * count;
    }
  };

  make_row<kEight>(view, layout, 0, scratch.window[0]);
  make_row<kEight>(view, layout, 1, scratch.window[1]);
  scratch.shaded[1].count = 0;  // nothing before the first section
  for (std::uint32_t k = 0; k <= last + 1; ++k) {
    // Section k - 1 is written before its window's place is needed again, at k + 3.
    if (k + 2 <= last) make_row<kEight>(view, layout, k + 2, scratch.window[(k + 2) & 3]);
    if (k <= last) shade_section<kEight>(view, layout, k, scratch, scratch.shaded[k & 1]);
    if (k > 0) write_section(scratch.shaded[(k - 1) & 1]);
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
  SurfaceScratch scratch;
  // Lanes beyond a row's end are computed, if not written: keep them numbers.
  __builtin_memset(scratch.window, 0, sizeof(scratch.window));
  const SectionsView& view = job.sections;
  for (std::uint32_t muscle = 0; muscle < view.muscle_count; ++muscle) {
    if (view.attached != nullptr && view.attached[muscle] == 0) {
      collapse_muscle(view, muscle, job.vertices);
    } else if (view.layouts[muscle].section_vertices == 8) {
      write_muscle<kStream, true>(view, muscle, scratch, job.vertices);
    } else {
      write_muscle<kStream, false>(view, muscle, scratch, job.vertices);
    }
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
