// Edges and dihedral angles (4.1), as many hinges side by side as the instruction set has lanes.
//
// With e = p_2 - p_1, L = |e|, a = p_3 - p_1, b = p_4 - p_1, N_1 = e x a and N_2 = b x e the angle is
// theta = atan2(-L N_1 . b, N_1 . N_2), since N_1 x N_2 = -(N_1 . b) e. Its gradients are
//
//   g_3 = -L N_1 / |N_1|^2          g_1 = -((L - s_3) g_3 + (L - s_4) g_4) / L
//   g_4 = -L N_2 / |N_2|^2          g_2 = -(s_3 g_3 + s_4 g_4) / L              s_3 = a . e / L,  s_4 = b . e / L
//
// so that all their squared lengths are known from |N_1|^2, |N_2|^2 and N_1 . N_2. Everything is multiplied by
// |N_1|^2 |N_2|^2, which leaves one quotient for the angle's step. A step of the edge moves p_1 and p_2 along e: it
// changes L, s_3 and s_4, but neither the heights |N| / L nor theta, so the angle is projected after the edge, yet need
// not wait for it. For the kernels' source files only (see engine/math/wide_float.hpp).
#pragma once

#include "engine/math/wide_float.hpp"
#include "modules/muscle/kernels/surface/surface_kernel_data.hpp"
#include "modules/muscle/kernels/surface/surface_kernels.hpp"

namespace fascicle::muscle::FASCICLE_ISA {

using namespace fascicle::FASCICLE_ISA;

inline constexpr float kPi = 3.14159265f;
inline constexpr float kSmallestSum = 1.0e-36f;  // divisors below have lost their digits

// The angle of (x, y) in [-pi, pi] to 7e-7 of its value; (0, 0) gives no number.
template <int N>
FASCICLE_INLINE WideFloat<N> arc_tangent(WideFloat<N> y, WideFloat<N> x) {
  const WideFloat<N> height = absolute(y), width = absolute(x);
  const WideInt<N> steep = width < height;
  const WideFloat<N> z = select(steep, width, height) / select(steep, height, width);
  const WideFloat<N> t = z * z, t2 = t * t;
  // The best polynomial of its degree for (atan(z) / z - 1) / z^2 on [0, 1], by relative error of the angle.
  const WideFloat<N> low = broadcast<N>(-0.333284914f) + 0.198978737f * t;
  const WideFloat<N> middle = broadcast<N>(-0.135445759f) + 0.0848410428f * t;
  const WideFloat<N> high = broadcast<N>(-0.0377967246f) + 0.00810636953f * t;
  const WideFloat<N> flat = z + (z * t) * (low + t2 * (middle + t2 * high));
  const WideFloat<N> right = select(steep, broadcast<N>(0.5f * kPi) - flat, flat);
  const WideFloat<N> above = select(x < broadcast<N>(0.0f), broadcast<N>(kPi) - right, right);
  return from_bits(bits_of(above) | (bits_of(y) & broadcast_int<N>(static_cast<int>(0x80000000u))));
}

// An angle's difference, within one turn of 0, as the shortest way round.
template <int N>
FASCICLE_INLINE WideFloat<N> wrap(WideFloat<N> a) {
  const WideFloat<N> down = a - 2.0f * kPi, up = a + 2.0f * kPi;
  return select(broadcast<N>(kPi) < a, down, select(a < broadcast<N>(-kPi), up, a));
}

template <int N>
FASCICLE_INLINE WideVector<N> place(const WideRecord<N>& p) { return {p.x, p.y, p.z}; }

template <int N>
FASCICLE_INLINE void move(WideRecord<N>& p, WideVector<N> by) {
  p.x = p.x + by.x;
  p.y = p.y + by.y;
  p.z = p.z + by.z;
}

template <int N>
FASCICLE_INLINE void move_back(WideRecord<N>& p, WideVector<N> by) {
  p.x = p.x - by.x;
  p.y = p.y - by.y;
  p.z = p.z - by.z;
}

// A hinge's shape: all that its constraints and their gradients need.
template <int N>
struct Fold {
  WideInt<N> has_edge, has_angle;
  WideVector<N> edge;                      // m: e
  WideFloat<N> length, inverse_length;     // m, 1/m; the latter is 0 where there is no edge
  WideFloat<N> along_3, along_4;           // m: s_3 and s_4
  WideVector<N> normal_3, normal_4;        // m^2: N_1 and N_2
  WideFloat<N> square_3, square_4, mixed;  // m^4: |N_1|^2, |N_2|^2, N_1 . N_2
  WideFloat<N> angle;                      // rad; 0 where there is none
};

template <int N>
FASCICLE_INLINE Fold<N> fold_of(const WideRecord<N>& p1, const WideRecord<N>& p2, const WideRecord<N>& p3,
                                const WideRecord<N>& p4) {
  Fold<N> fold;
  const WideFloat<N> zero = broadcast<N>(0.0f);
  const WideVector<N> e = place(p2) - place(p1), a = place(p3) - place(p1), b = place(p4) - place(p1);
  const WideFloat<N> square = dot(e, e);
  fold.has_edge = broadcast<N>(kShortestEdge * kShortestEdge) < square;
  fold.length = square_root(square);
  fold.edge = e;
  fold.inverse_length = select(fold.has_edge, broadcast<N>(1.0f) / fold.length, zero);
  fold.along_3 = fold.inverse_length * dot(a, e);
  fold.along_4 = fold.inverse_length * dot(b, e);
  fold.normal_3 = cross(e, a);
  fold.normal_4 = cross(b, e);
  fold.square_3 = dot(fold.normal_3, fold.normal_3);
  fold.square_4 = dot(fold.normal_4, fold.normal_4);
  fold.mixed = dot(fold.normal_3, fold.normal_4);
  const WideFloat<N> least = broadcast<N>(kSmallestArea2);
  fold.has_angle = fold.has_edge & (least < fold.square_3) & (least < fold.square_4);
  const WideFloat<N> sine = zero - fold.length * dot(fold.normal_3, b);
  fold.angle = select(fold.has_angle, arc_tangent(sine, fold.mixed), zero);
  return fold;
}

struct PackRow {
  const int* vertex[4];
  const float *length, *stretch_compliance, *angle, *bend_compliance;
};

FASCICLE_INLINE PackRow row_of(const HingePack& pack) {
  const int* vertices = reinterpret_cast<const int*>(&pack.vertex);
  return {{vertices, vertices + kHingeLanes, vertices + 2 * kHingeLanes, vertices + 3 * kHingeLanes},
          reinterpret_cast<const float*>(&pack.length),
          reinterpret_cast<const float*>(&pack.stretch_compliance),
          reinterpret_cast<const float*>(&pack.angle),
          reinterpret_cast<const float*>(&pack.bend_compliance)};
}

template <int N>
FASCICLE_INLINE void project_lanes(const PackRow& row, std::size_t lane, float* points, WideFloat<N> inverse_h2) {
  WideRecord<N> p1 = load_records<N>(points, row.vertex[0] + lane), p2 = load_records<N>(points, row.vertex[1] + lane);
  WideRecord<N> p3 = load_records<N>(points, row.vertex[2] + lane), p4 = load_records<N>(points, row.vertex[3] + lane);
  const Fold<N> fold = fold_of(p1, p2, p3, p4);
  const WideFloat<N> zero = broadcast<N>(0.0f);

  // The edge.
  const WideFloat<N> masses = p1.w + p2.w;
  const WideFloat<N> stretch = masses + inverse_h2 * load<N>(row.stretch_compliance + lane);
  const WideFloat<N> step = select(fold.has_edge & (zero < masses),
                                   (load<N>(row.length + lane) - fold.length) / stretch, zero);
  const WideFloat<N> back = p1.w * step, forth = p2.w * step;
  const WideFloat<N> length = fold.length + (back + forth);
  const WideFloat<N> along_3 = fold.along_3 + back, along_4 = fold.along_4 + back;

  // The angle.
  const WideFloat<N> rest_3 = length - along_3, rest_4 = length - along_4;
  const WideFloat<N> twice = fold.mixed + fold.mixed, square = length * length;
  const WideFloat<N> q1 = rest_3 * (rest_3 * fold.square_4 + twice * rest_4) + (rest_4 * rest_4) * fold.square_3;
  const WideFloat<N> q2 = along_3 * (along_3 * fold.square_4 + twice * along_4) + (along_4 * along_4) * fold.square_3;
  const WideFloat<N> q34 = p3.w * fold.square_4 + p4.w * fold.square_3;
  const WideFloat<N> height_4 = fold.square_4 * (fold.inverse_length * fold.inverse_length);  // squared, of p_4
  const WideFloat<N> bend = inverse_h2 * load<N>(row.bend_compliance + lane) * (fold.square_3 * height_4);
  const WideFloat<N> sum = square * (q34 + bend) + (p1.w * q1 + p2.w * q2);
  const WideFloat<N> turn = wrap(fold.angle - load<N>(row.angle + lane));
  const WideFloat<N> factor =
      select(fold.has_angle & (broadcast<N>(kSmallestSum) < sum), (turn * fold.inverse_length) / sum, zero);
  const WideVector<N> lift_3 = fold.square_4 * fold.normal_3, lift_4 = fold.square_3 * fold.normal_4;

  const WideFloat<N> outer = factor * square, inner = factor * length;
  move(p3, (p3.w * outer) * lift_3);
  move(p4, (p4.w * outer) * lift_4);
  const WideVector<N> sag_1 = rest_3 * lift_3 + rest_4 * lift_4, sag_2 = along_3 * lift_3 + along_4 * lift_4;
  move_back(p1, (back * fold.inverse_length) * fold.edge + (p1.w * inner) * sag_1);
  move(p2, (forth * fold.inverse_length) * fold.edge - (p2.w * inner) * sag_2);
  store_records_at(p1, points, row.vertex[0] + lane);
  store_records_at(p2, points, row.vertex[1] + lane);
  store_records_at(p3, points, row.vertex[2] + lane);
  store_records_at(p4, points, row.vertex[3] + lane);
}

inline void project_hinges(const HingeRows& rows) {
  // Two native registers where a pack has so many: one's arithmetic fills the other's waiting times.
  constexpr int N = 2 * kNativeLanes < static_cast<int>(kHingeLanes) ? 2 * kNativeLanes : static_cast<int>(kHingeLanes);
  float* points = reinterpret_cast<float*>(rows.points);
  const WideFloat<N> inverse_h2 = broadcast<N>(rows.inverse_h2);
  for (std::size_t i = 0; i < rows.pack_count; ++i) {
    const PackRow row = row_of(rows.packs[i]);
    for (std::size_t lane = 0; lane < kHingeLanes; lane += N) project_lanes<N>(row, lane, points, inverse_h2);
  }
}

inline void measure_hinges(const HingeRuler& ruler) {
  constexpr int N = kNativeLanes;
  const float* points = reinterpret_cast<const float*>(ruler.points);
  for (std::size_t i = 0; i < ruler.pack_count; ++i) {
    const PackRow row = row_of(ruler.packs[i]);
    for (std::size_t lane = 0; lane < kHingeLanes; lane += N) {
      const Fold<N> fold = fold_of(
          load_records<N>(points, row.vertex[0] + lane), load_records<N>(points, row.vertex[1] + lane),
          load_records<N>(points, row.vertex[2] + lane), load_records<N>(points, row.vertex[3] + lane));
      store(fold.length, ruler.lengths + i * kHingeLanes + lane);
      store(fold.angle, ruler.angles + i * kHingeLanes + lane);
    }
  }
}

inline void fade_differences(const ViscosityRows& rows) {
  constexpr int N = kNativeLanes;
  const float* points = reinterpret_cast<const float*>(rows.points);
  float* velocities = reinterpret_cast<float*>(rows.velocity);
  const WideFloat<N> share = broadcast<N>(rows.share), zero = broadcast<N>(0.0f);
  for (std::size_t i = 0; i < rows.pack_count; ++i) {
    const PackRow row = row_of(rows.packs[i]);
    for (std::size_t lane = 0; lane < kHingeLanes; lane += N) {
      const int *first = row.vertex[0] + lane, *second = row.vertex[1] + lane;
      const WideFloat<N> w1 = load_records<N>(points, first).w, w2 = load_records<N>(points, second).w;
      WideRecord<N> v1 = load_records<N>(velocities, first), v2 = load_records<N>(velocities, second);
      const WideFloat<N> masses = w1 + w2;
      const WideFloat<N> factor = select(zero < masses, share / masses, zero);
      const WideVector<N> push = factor * (place(v2) - place(v1));
      move(v1, w1 * push);
      move_back(v2, w2 * push);
      store_records_at(v1, velocities, first);
      store_records_at(v2, velocities, second);
    }
  }
}

}  // namespace fascicle::muscle::FASCICLE_ISA
