// A section's vertices, c_i = a + r_i (cos(theta_i) u + sin(theta_i) v) (1.3), as rows of numbers, and the differences
// around it, e_i = c_{i+1} - c_{i-1}.
//
// The differences are loads of the neighbours, which straddle the stores that made the row; such a load waits until
// those stores have left the store queue. With |C| = 8 rows are so short that they would not have, so this common case
// turns its one vector in registers instead, and stores the differences.
// For the kernels' source files only (see engine/math/wide_float.hpp).
#pragma once

#include "engine/math/wide_float.hpp"
#include "modules/muscle/kernels/mtu_kernels.hpp"

namespace fascicle::muscle::FASCICLE_ISA {

using namespace fascicle::FASCICLE_ISA;

// Room for |C| vertices, one neighbour before and a vector's overhang after.
inline constexpr std::size_t kRowStart = 16;
inline constexpr std::size_t kRowCapacity = kRowStart + kMaxSectionVertices + 16;

struct SectionRow {
  alignas(64) float x[kRowCapacity], y[kRowCapacity], z[kRowCapacity];
  alignas(64) float ex[8], ey[8], ez[8];  // differences where |C| = 8
};

template <int N>
FASCICLE_INLINE WideVector<N> load_vertices(const SectionRow& row, std::size_t i) {
  return {load<N>(row.x + kRowStart + i), load<N>(row.y + kRowStart + i), load<N>(row.z + kRowStart + i)};
}
template <int N>
FASCICLE_INLINE void store_vertices(WideVector<N> c, std::size_t i, SectionRow& row) {
  store(c.x, row.x + kRowStart + i);
  store(c.y, row.y + kRowStart + i);
  store(c.z, row.z + kRowStart + i);
}
template <bool kEight, int N>
FASCICLE_INLINE WideVector<N> load_differences(const SectionRow& row, std::size_t i) {
  if constexpr (kEight) return {load<N>(row.ex), load<N>(row.ey), load<N>(row.ez)};
  else return load_vertices<N>(row, i + 1) - load_vertices<N>(row, i - 1);
}

// Calls f(width, i) so that [0, count) is covered with the fewest and widest vectors: `width` is a Lanes<N>, and
// [i, i + N) lies within the section. The last vector overlaps the one before, and writes the same numbers twice, where
// |C| is no multiple of N.
template <int N>
struct Lanes {
  static constexpr int kCount = N;
};
template <bool kEight, class F>
FASCICLE_INLINE void for_lanes(std::size_t count, F f) {
  if constexpr (kEight) {
    f(Lanes<8>{}, std::size_t{0});
  } else {
    std::size_t i = 0;
    if constexpr (kNativeLanes >= 16) {
      for (; i + 16 <= count; i += 16) f(Lanes<16>{}, i);
    }
    for (; i + 8 <= count; i += 8) f(Lanes<8>{}, i);
    if (i == count) return;
    if (count - i > 4 && count >= 8) {
      f(Lanes<8>{}, count - 8);
    } else {
      if (count - i > 4) f(Lanes<4>{}, i);
      f(Lanes<4>{}, count - 4);
    }
  }
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

// p u + q v.
template <int N>
FASCICLE_INLINE WideVector<N> in_plane(const SectionFrame& frame, WideFloat<N> p, WideFloat<N> q) {
  return {frame.ux * p + frame.vx * q, frame.uy * p + frame.vy * q, frame.uz * p + frame.vz * q};
}

// cos(theta) u + sin(theta) v.
template <int N>
FASCICLE_INLINE WideVector<N> radial_direction(const SectionFrame& frame, const Circle& circle, std::size_t i) {
  return in_plane(frame, load<N>(circle.cosines + i), load<N>(circle.sines + i));
}

alignas(64) inline constexpr int kLaneNumbers[16] = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15};

// The radii of the vertices after i, i + 1, ...: the last of the section is followed by the first. Reads one row ahead.
template <int N>
FASCICLE_INLINE WideFloat<N> radii_after(const float* radii, std::uint32_t i, std::uint32_t section_vertices) {
  const WideFloat<N> next = load<N>(radii + i + 1);
  if (i + N < section_vertices) return next;
  const WideInt<N> last = load_int<N>(kLaneNumbers) == broadcast_int<N>(static_cast<int>(section_vertices - 1 - i));
  return select(last, broadcast<N>(radii[0]), next);
}
FASCICLE_INLINE const float* radii_of(const SectionsView& view, const SectionLayout& layout, std::uint32_t k) {
  return view.radii + layout.first_radius + std::size_t{layout.radius_stride} * k;
}

// Fills `row` with section k's vertices.
template <bool kEight>
FASCICLE_INLINE void make_row(const SectionsView& view, const SectionLayout& layout, std::uint32_t k,
                              SectionRow& row) {
  const SectionFrame frame = load_frame(view, layout, k);
  const Circle circle = view.circles[layout.circle];
  const float* radii = radii_of(view, layout, k);
  const std::size_t count = layout.section_vertices;
  for_lanes<kEight>(count, [&](auto lanes, std::size_t i) __attribute__((always_inline)) {
    constexpr int N = decltype(lanes)::kCount;
    const WideFloat<N> r = load<N>(radii + i);
    WideVector<N> c = in_plane(frame, r * load<N>(circle.cosines + i), r * load<N>(circle.sines + i));
    c = {c.x + frame.ax, c.y + frame.ay, c.z + frame.az};
    store_vertices(c, i, row);
    if constexpr (kEight) {
      store(rotate_down(c.x) - rotate_up(c.x), row.ex);
      store(rotate_down(c.y) - rotate_up(c.y), row.ey);
      store(rotate_down(c.z) - rotate_up(c.z), row.ez);
    }
  });
  if constexpr (!kEight) {  // the last vertex before the first, the first behind the last
    const auto go_round = [&](float* x) __attribute__((always_inline)) {
      x[-1] = x[count - 1];
      x[count] = x[0];
    };
    go_round(row.x + kRowStart);
    go_round(row.y + kRowStart);
    go_round(row.z + kRowStart);
  }
}

}  // namespace fascicle::muscle::FASCICLE_ISA
