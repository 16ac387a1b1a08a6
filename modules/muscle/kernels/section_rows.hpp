// A section's vertices, c_i = a + r_i (cos(theta_i) u + sin(theta_i) v) (1.3), as three rows of x, y and z with their
// neighbours around the corner at both ends, so that i - 1 and i + 1 can be loaded for any i.
// For the kernels' source files only (see engine/math/wide_float.hpp).
#pragma once

#include "engine/math/wide_float.hpp"
#include "modules/muscle/kernels/mtu_kernels.hpp"

namespace fascicle::muscle::FASCICLE_ISA {

using namespace fascicle::FASCICLE_ISA;

// Room for |C| vertices, one neighbour before and a vector's overhang after.
inline constexpr std::uint32_t kRowStart = 16;
inline constexpr std::uint32_t kRowCapacity = kRowStart + kMaxSectionVertices + 16;

struct SectionRow {
  alignas(64) float x[kRowCapacity], y[kRowCapacity], z[kRowCapacity];
};

template <int N>
FASCICLE_INLINE WideVector<N> load_row(const SectionRow& row, std::uint32_t i, int offset = 0) {
  const std::uint32_t at = kRowStart + i + static_cast<std::uint32_t>(offset);
  return {load<N>(row.x + at), load<N>(row.y + at), load<N>(row.z + at)};
}

template <int N>
FASCICLE_INLINE void store_row(WideVector<N> c, std::uint32_t i, SectionRow& row) {
  store(c.x, row.x + kRowStart + i);
  store(c.y, row.y + kRowStart + i);
  store(c.z, row.z + kRowStart + i);
}

// Copies the last vertex before the first and the first behind the last.
FASCICLE_INLINE void close_row(std::uint32_t count, SectionRow& row) {
  row.x[kRowStart - 1] = row.x[kRowStart + count - 1];
  row.y[kRowStart - 1] = row.y[kRowStart + count - 1];
  row.z[kRowStart - 1] = row.z[kRowStart + count - 1];
  row.x[kRowStart + count] = row.x[kRowStart];
  row.y[kRowStart + count] = row.y[kRowStart];
  row.z[kRowStart + count] = row.z[kRowStart];
}

// Calls f(width, i, count) over [0, count) with the widest vectors that fit, then narrower ones: |C| = 36 is 4 x 8 + 4
// on AVX2 and 2 x 16 + 4 on AVX-512, with no lane idle. `width` is a Lanes<N>; `count` is N except perhaps at the end.
template <int N>
struct Lanes {
  static constexpr int kCount = N;
};
template <class F>
FASCICLE_INLINE void for_lanes(std::uint32_t count, F f) {
  std::uint32_t i = 0;
  if constexpr (kNativeLanes >= 16) {
    for (; i + 16 <= count; i += 16) f(Lanes<16>{}, i, 16u);
  }
  if constexpr (kNativeLanes >= 8) {
    for (; i + 8 <= count; i += 8) f(Lanes<8>{}, i, 8u);
  }
  for (; i + 4 <= count; i += 4) f(Lanes<4>{}, i, 4u);
  if (i < count) f(Lanes<4>{}, i, count - i);
}

// One section's centre and directions.
struct SectionFrame {
  float ax, ay, az, ux, uy, uz, vx, vy, vz;
};

FASCICLE_INLINE SectionFrame load_frame(const SectionsView& view, const SectionLayout& layout, std::uint32_t k) {
  const std::size_t slot = layout.first_slot + std::size_t{kLanes} * k;
  return {view.x[slot],  view.y[slot],  view.z[slot],  view.ux[slot], view.uy[slot],
          view.uz[slot], view.vx[slot], view.vy[slot], view.vz[slot]};
}

// cos(theta) u + sin(theta) v.
template <int N>
FASCICLE_INLINE WideVector<N> radial_direction(const SectionFrame& frame, const Circle& circle, std::uint32_t i) {
  const WideFloat<N> cosine = load<N>(circle.cosines + i), sine = load<N>(circle.sines + i);
  return {frame.ux * cosine + frame.vx * sine, frame.uy * cosine + frame.vy * sine,
          frame.uz * cosine + frame.vz * sine};
}

// Fills `row` with section k's vertices; with kRelative as seen from the centre a_k.
template <bool kRelative>
FASCICLE_INLINE void make_row(const SectionsView& view, const SectionLayout& layout, std::uint32_t k,
                              SectionRow& row) {
  const SectionFrame frame = load_frame(view, layout, k);
  const Circle circle = view.circles[layout.circle];
  const float* radii = view.radii + layout.first_radius + std::size_t{layout.radius_stride} * k;
  for_lanes(layout.section_vertices, [&](auto lanes, std::uint32_t i, std::uint32_t) __attribute__((always_inline)) {
    constexpr int N = decltype(lanes)::kCount;
    const WideFloat<N> r = load<N>(radii + i);
    const WideFloat<N> p = r * load<N>(circle.cosines + i), q = r * load<N>(circle.sines + i);
    WideVector<N> c{frame.ux * p + frame.vx * q, frame.uy * p + frame.vy * q, frame.uz * p + frame.vz * q};
    if constexpr (!kRelative) {
      c = {c.x + frame.ax, c.y + frame.ay, c.z + frame.az};
    }
    store_row(c, i, row);
  });
  close_row(layout.section_vertices, row);
}

}  // namespace fascicle::muscle::FASCICLE_ISA
