// Sections -> the drawn surface: positions (1.3), normals, the tendon sections C_t (1.4) and the cap centres.
//
// Normals are central differences: around the section, e = c_{i+1} - c_{i-1}, and along the muscle,
// d = c^{k+1} - c^{k-1} (one-sided at the ends); n = e x d points outwards. Where it vanishes (radii of zero) it is the
// radial direction. A tendon section interpolates the vertices and the normals of the two sections beside it, as a
// graphics processor does between them, so neither shape nor shading changes as a tendon's end passes by; sections'
// own differences skip it.
//
// A muscle is written front to back, three sections at a time in different stages of work, in the first-level cache: a
// vertex's chain of dependent operations is 70 cycles long, and the processor sees only two vectors' worth of
// instructions ahead. So each stage's results are of no use to any instruction nearby.
// For the kernels' source files only (see engine/math/wide_float.hpp).
#pragma once

#include "engine/math/wide_float.hpp"
#include "modules/muscle/kernels/section_rows.hpp"

namespace fascicle::muscle::FASCICLE_ISA {

// Squared length (m^4) below which a normal has no direction.
inline constexpr float kSmallestNormalSquared = 1.0e-34f;
// Length of a normal before its components are rounded to 10 bits.
inline constexpr float kPackedLength = 511.0f;

// 10:10:10:2 signed, from components of length 511: added up with a bias that keeps each field positive, so that no
// sign spills into the next, and which is then taken off by flipping each field's highest bit.
template <int N>
FASCICLE_INLINE WideFloat<N> pack_normal(WideVector<N> n) {
  const WideInt<N> bias = broadcast_int<N>(512 | 512 << 10 | 512 << 20);
  const WideInt<N> sum =
      round_to_int(n.x) + shift_left(round_to_int(n.y), 10) + shift_left(round_to_int(n.z), 20) + bias;
  return from_bits(sum ^ bias);
}

// A row's normals between its stages.
struct ShadedRow {
  alignas(64) float x[kRowCapacity], y[kRowCapacity], z[kRowCapacity];  // e x d
  alignas(64) float squared[kRowCapacity];
  alignas(64) float scale[kRowCapacity];  // kPackedLength / |e x d|
};

template <int N>
FASCICLE_INLINE WideVector<N> load_normals(const ShadedRow& row, std::size_t i) {
  return {load<N>(row.x + i), load<N>(row.y + i), load<N>(row.z + i)};
}
template <int N>
FASCICLE_INLINE void store_normals(WideVector<N> normal, WideFloat<N> squared, std::size_t i, ShadedRow& row) {
  store(normal.x, row.x + i);
  store(normal.y, row.y + i);
  store(normal.z, row.z + i);
  store(inverse_root(squared, kPackedLength), row.scale + i);
}

// What a muscle is written by; section k is in window[k & 3], its normals in shaded[k & 3].
struct SurfaceScratch {
  SectionRow window[4];
  ShadedRow shaded[4];
};

// Puts the radial direction in the place of normals that have vanished.
[[gnu::noinline, gnu::cold]] inline void replace_vanished(const SectionsView& view, const SectionLayout& layout,
                                                          std::uint32_t k, ShadedRow& shaded) {
  const SectionFrame frame = load_frame(view, layout, k);
  for_lanes<false>(layout.section_vertices, [&](auto lanes, std::size_t i) {
    constexpr int N = decltype(lanes)::kCount;
    const WideVector<N> normal = load_normals<N>(shaded, i);
    const WideInt<N> vanished = dot(normal, normal) < broadcast<N>(kSmallestNormalSquared);
    const WideVector<N> sure = select(vanished, radial_direction<N>(frame, view.circles[layout.circle], i), normal);
    store_normals(sure, dot(sure, sure), i, shaded);
  });
}

// Stage 2, after make_row: normals from the differences, and what scales them.
template <bool kEight>
FASCICLE_INLINE void shade_row(const SectionsView& view, const SectionLayout& layout, std::uint32_t k,
                               SurfaceScratch& scratch) {
  const std::uint32_t last = layout.section_count - 1;
  const SectionRow& before = scratch.window[(k == 0 ? 0 : k - 1) & 3];
  const SectionRow& here = scratch.window[k & 3];
  const SectionRow& next = scratch.window[(k == last ? last : k + 1) & 3];
  ShadedRow& shaded = scratch.shaded[k & 3];
  bool vanished = false;
  for_lanes<kEight>(layout.section_vertices, [&](auto lanes, std::size_t i) __attribute__((always_inline)) {
    constexpr int N = decltype(lanes)::kCount;
    const WideVector<N> d = load_vertices<N>(next, i) - load_vertices<N>(before, i);
    const WideVector<N> normal = cross(load_differences<kEight, N>(here, i), d);
    const WideFloat<N> squared = dot(normal, normal);
    vanished |= any(squared < broadcast<N>(kSmallestNormalSquared));
    store_normals(normal, squared, i, shaded);
  });
  if (vanished) [[unlikely]] replace_vanished(view, layout, k, shaded);
}

template <bool kStream, int N>
FASCICLE_INLINE void write_vertices(WideVector<N> c, WideVector<N> normal, float* to) {
  store_records<kStream>(c.x, c.y, c.z, pack_normal(normal), to);
}

// Stage 3: the section as it is drawn.
template <bool kStream, bool kEight>
FASCICLE_INLINE void write_row(const SectionLayout& layout, const SectionRow& row, const ShadedRow& shaded, float* to) {
  for_lanes<kEight>(layout.section_vertices, [&](auto lanes, std::size_t i) __attribute__((always_inline)) {
    constexpr int N = decltype(lanes)::kCount;
    write_vertices<kStream>(load_vertices<N>(row, i), load<N>(shaded.scale + i) * load_normals<N>(shaded, i),
                            to + kFloatsPerVertex * i);
  });
}

// A tendon section between sections k and k + 1; where their normals are opposite it takes the former's.
template <bool kStream, bool kEight>
inline void write_tendon(const SectionLayout& layout, std::uint32_t k, float fraction, const SurfaceScratch& scratch,
                         float* to) {
  const SectionRow& before = scratch.window[k & 3];
  const SectionRow& after = scratch.window[(k + 1) & 3];
  const ShadedRow& shaded_before = scratch.shaded[k & 3];
  const ShadedRow& shaded_after = scratch.shaded[(k + 1) & 3];
  for_lanes<kEight>(layout.section_vertices, [&](auto lanes, std::size_t i) __attribute__((always_inline)) {
    constexpr int N = decltype(lanes)::kCount;
    const WideFloat<N> s = broadcast<N>(fraction);
    const WideVector<N> c = load_vertices<N>(before, i);
    const WideVector<N> a = load<N>(shaded_before.scale + i) * load_normals<N>(shaded_before, i);
    const WideVector<N> b = load<N>(shaded_after.scale + i) * load_normals<N>(shaded_after, i);
    const WideVector<N> between = a + s * (b - a);
    const WideVector<N> normal = select(dot(between, between) < broadcast<N>(1.0f), a, between);
    write_vertices<kStream>(c + s * (load_vertices<N>(after, i) - c),
                            inverse_root(dot(normal, normal), kPackedLength) * normal, to + kFloatsPerVertex * i);
  });
}

// The tendon sections of one muscle: segment (none: -2) and place in it.
struct TendonRows {
  std::int32_t segment[2];
  float fraction[2];

  TendonRows(const SectionsView& view, const SectionLayout& layout) {
    for (int end = 0; end < 2; ++end) {
      segment[end] = layout.tendon_drawn[end] ? view.segment[end][layout.lane_index] : -2;
      fraction[end] = view.fraction[end][layout.lane_index];
    }
  }
};

// All rows; returns what comes behind them.
template <bool kStream, bool kEight>
inline float* write_rows(const SectionsView& view, const SectionLayout& layout, SurfaceScratch& scratch, float* to) {
  const std::size_t floats = std::size_t{kFloatsPerVertex} * layout.section_vertices;
  const std::uint32_t count = layout.section_count;
  TendonRows tendons(view, layout);
  make_row<kEight>(view, layout, 0, scratch.window[0]);
  make_row<kEight>(view, layout, 1, scratch.window[1]);
  for (std::uint32_t k = 0; k < count + 2; ++k) {
    if (k >= 2) {
      write_row<kStream, kEight>(layout, scratch.window[(k - 2) & 3], scratch.shaded[(k - 2) & 3], to);
      to += floats;
      for (int end = 0; end < 2; ++end) {
        if (tendons.segment[end] != static_cast<std::int32_t>(k - 2)) continue;
        write_tendon<kStream, kEight>(layout, k - 2, tendons.fraction[end], scratch, to);
        to += floats;
      }
    }
    if (k + 2 < count) make_row<kEight>(view, layout, k + 2, scratch.window[(k + 2) & 3]);
    if (k < count) shade_row<kEight>(view, layout, k, scratch);
  }
  return to;
}

// A cap centre.
template <bool kStream>
FASCICLE_INLINE void write_centre(const SectionFrame& f, float sign, float* to) {
  const float length = sign * kPackedLength;
  const WideVector<4> normal{broadcast<4>(length * (f.uy * f.vz - f.uz * f.vy)),
                             broadcast<4>(length * (f.uz * f.vx - f.ux * f.vz)),
                             broadcast<4>(length * (f.ux * f.vy - f.uy * f.vx))};
  const WideFloat<4> packed = pack_normal(normal);
  store_four(to, _mm_setr_ps(f.ax, f.ay, f.az, packed.v[0]), kStream);
}

template <bool kStream>
inline void write_muscle(const SectionsView& view, std::uint32_t muscle, SurfaceScratch& scratch, float* vertices) {
  const SectionLayout& layout = view.layouts[muscle];
  float* const first = vertices + kFloatsPerVertex * std::size_t{layout.first_vertex};
  float* const centres = layout.section_vertices == 8 ? write_rows<kStream, true>(view, layout, scratch, first)
                                                      : write_rows<kStream, false>(view, layout, scratch, first);
  write_centre<kStream>(load_frame(view, layout, 0), -1.0f, centres);
  write_centre<kStream>(load_frame(view, layout, layout.section_count - 1), 1.0f, centres + kFloatsPerVertex);
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
  const SectionsView& view = job.sections;
  for (std::uint32_t muscle = 0; muscle < view.muscle_count; ++muscle) {
    if (view.attached != nullptr && view.attached[muscle] == 0) {
      collapse_muscle(view, muscle, job.vertices);
    } else {
      write_muscle<kStream>(view, muscle, scratch, job.vertices);
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
