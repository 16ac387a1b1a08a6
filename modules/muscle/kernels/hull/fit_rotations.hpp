// The rotations nearest to 16 matrices S side by side: those with the greatest f(R) = sum R_ij S_ij.
// For the kernels' source files only (see engine/math/wide_float.hpp).
//
// Mueller et al. 2016 turn R by omega = a / |tr M|, M = S R^T, a = (M_zy - M_yz, M_xz - M_zx, M_yx - M_xy), which is
// their sum of R_k x S_k: a step along the slope that leaves a constant part of the error, half of it for round S,
// nearly all of it for thin S. This goes to the second order instead. About the axis n by the angle t,
//   f(t) = f - n^T H n + n^T H n cos t + a . n sin t,    H = tr(M) I - (M + M^T) / 2,
// whose greatest value is at tan t = a . n / n^T H n. The axis is that of Newton's step d = H^-1 a, for which tan t =
// |d| exactly, so that the turn's quaternion is
//   (1 + sqrt(1 + d^2), d):
// no sine, no arc. It is the step of a Rayleigh quotient iteration on Horn's 4 x 4 matrix of S (1987), but for the
// angle's third order, and it converges as that does, cubically: from 17 degrees away two turns reach the accuracy of
// floats. No turn can make f less.
//
// Where H is not safely positive definite, which is nearer to a saddle or to where two rotations are equally good
// (mirrored and thin S), slower ways take its place, lane by lane:
//   - H + m I with a small m = a^2 / (2 |a| + tr M) + 10^-4, if that is definite: bounds what has no direction;
//   - else the axis along which f curves upwards the most, H's least eigenvector, as the greatest column of
//     ((H + m I)^-1)^8 with H + m I just definite (2 m > sqrt(3) |S| - tr M). It leaves a saddle, such as a turn by 180
//     degrees, at once.
// Both choose the angle by f(t), too.
//
// S counts by its direction only: it is scaled to |S| = 1. R stays a rotation to the rounding of floats: it is made
// orthogonal again after every fit (Gram and Schmidt). A lane stops when its turn was small enough for the next to be
// less than rounding, so its result does not depend on its neighbours.
#pragma once

#include "engine/math/wide_float.hpp"
#include "modules/muscle/kernels/hull/hull_kernel_data.hpp"

namespace fascicle::muscle::FASCICLE_ISA {

using namespace fascicle::FASCICLE_ISA;

using Lanes = WideFloat<16>;
using Mask = WideInt<16>;
using Vector = WideVector<16>;

struct LanesMatrix {
  Vector row[3];
};
struct SymmetricMatrix {
  Lanes xx, yy, zz, yz, xz, xy;
};

inline constexpr float kLeastSquare = 1.0e-30f;     // of |S|; below, S is zero
inline constexpr float kGreatestSquare = 1.0e30f;
inline constexpr float kDefinite = 1.0e-3f;         // of H's minors, where |S| = 1
inline constexpr float kBarelyDefinite = 1.0e-7f;
inline constexpr float kSettledSquare = 1.0e-7f;    // of tan t: what is left is about tan^3 t / 12

FASCICLE_INLINE LanesMatrix load_matrix(const float* pack) {
  LanesMatrix result;
  for (int r = 0; r < 3; ++r) {
    result.row[r] = {load<16>(pack + 48 * r), load<16>(pack + 48 * r + 16), load<16>(pack + 48 * r + 32)};
  }
  return result;
}
FASCICLE_INLINE void store_matrix(const LanesMatrix& a, float* pack) {
  for (int r = 0; r < 3; ++r) {
    store(a.row[r].x, pack + 48 * r);
    store(a.row[r].y, pack + 48 * r + 16);
    store(a.row[r].z, pack + 48 * r + 32);
  }
}
FASCICLE_INLINE LanesMatrix select(Mask mask, const LanesMatrix& a, const LanesMatrix& b) {
  return {{select(mask, a.row[0], b.row[0]), select(mask, a.row[1], b.row[1]), select(mask, a.row[2], b.row[2])}};
}
FASCICLE_INLINE Lanes square_sum(const LanesMatrix& a) {
  return dot(a.row[0], a.row[0]) + dot(a.row[1], a.row[1]) + dot(a.row[2], a.row[2]);
}
FASCICLE_INLINE Mask invert(Mask mask) { return mask ^ broadcast_int<16>(-1); }

FASCICLE_INLINE Vector operator*(const SymmetricMatrix& m, Vector a) {
  return {m.xx * a.x + m.xy * a.y + m.xz * a.z, m.xy * a.x + m.yy * a.y + m.yz * a.z,
          m.xz * a.x + m.yz * a.y + m.zz * a.z};
}
FASCICLE_INLINE SymmetricMatrix add_diagonal(const SymmetricMatrix& m, Lanes a) {
  return {m.xx + a, m.yy + a, m.zz + a, m.yz, m.xz, m.xy};
}
FASCICLE_INLINE SymmetricMatrix adjugate(const SymmetricMatrix& m) {
  return {m.yy * m.zz - m.yz * m.yz, m.xx * m.zz - m.xz * m.xz, m.xx * m.yy - m.xy * m.xy,
          m.xy * m.xz - m.xx * m.yz, m.xy * m.yz - m.xz * m.yy, m.xz * m.yz - m.xy * m.zz};
}
FASCICLE_INLINE Lanes determinant(const SymmetricMatrix& m, const SymmetricMatrix& adjugate_of_m) {
  return m.xx * adjugate_of_m.xx + m.xy * adjugate_of_m.xy + m.xz * adjugate_of_m.xz;
}
// Its square over its trace, which keeps the greatest eigenvalue's order.
FASCICLE_INLINE SymmetricMatrix square(const SymmetricMatrix& m) {
  const Lanes scale = broadcast<16>(1.0f) / (m.xx + m.yy + m.zz);
  const SymmetricMatrix a{scale * m.xx, scale * m.yy, scale * m.zz, scale * m.yz, scale * m.xz, scale * m.xy};
  return {a.xx * a.xx + a.xy * a.xy + a.xz * a.xz, a.xy * a.xy + a.yy * a.yy + a.yz * a.yz,
          a.xz * a.xz + a.yz * a.yz + a.zz * a.zz, a.xy * a.xz + a.yy * a.yz + a.yz * a.zz,
          a.xx * a.xz + a.xy * a.yz + a.xz * a.zz, a.xx * a.xy + a.xy * a.yy + a.xz * a.yz};
}

// A turn, as a quaternion of any length.
struct Turn {
  Lanes w;
  Vector v;
  Lanes scale;  // 2 / length^2; 0: none
};

// About an axis of any length, by the angle that makes f greatest: with B = n^T H n and C = a . n the quaternion
// (B + |(B, C)|, C n), or, where B < 0, the same one without its cancellation, (C, (|(B, C)| - B) n).
FASCICLE_INLINE Turn turn_about(Vector axis, const SymmetricMatrix& h, Vector a) {
  const Lanes zero = broadcast<16>(0.0f), least = broadcast<16>(1.0e-37f);
  const Lanes length2 = dot(axis, axis), b = dot(axis, h * axis), c = dot(axis, a);
  const Lanes radius = square_root(b * b + c * c * length2);
  const Mask ahead = zero <= b;
  Turn turn;
  turn.w = select(ahead, b + radius, c * length2);
  turn.v = select(ahead, c, radius - b) * axis;
  const Lanes norm = turn.w * turn.w + dot(turn.v, turn.v);
  turn.scale = select(least < norm, broadcast<16>(2.0f) / norm, zero);
  return turn;
}

// The two slower ways.
FASCICLE_INLINE Turn find_careful_turn(const SymmetricMatrix& h, Vector a, Lanes trace) {
  const Lanes zero = broadcast<16>(0.0f), least = broadcast<16>(kBarelyDefinite);
  const Lanes a2 = dot(a, a);
  const SymmetricMatrix damped =
      add_diagonal(h, a2 / (2.0f * square_root(a2) + maximum(trace, zero) + broadcast<16>(1.0e-20f)) + 1.0e-4f);
  const SymmetricMatrix inverse = adjugate(damped);
  const Lanes det = determinant(damped, inverse);
  const Mask definite = (least < damped.xx) & (least < inverse.zz) & (least < det);
  const Vector gentle = (broadcast<16>(1.0f) / det) * (inverse * a);

  SymmetricMatrix upwards = adjugate(add_diagonal(h, 0.5f * (broadcast<16>(1.7325f) - trace) + 1.0e-3f));
  for (int i = 0; i < 3; ++i) upwards = square(upwards);
  const Mask y = upwards.xx < upwards.yy;
  const Vector column = select(y, Vector{upwards.xy, upwards.yy, upwards.yz}, {upwards.xx, upwards.xy, upwards.xz});
  const Mask z = maximum(upwards.xx, upwards.yy) < upwards.zz;
  const Vector steepest = select(z, Vector{upwards.xz, upwards.yz, upwards.zz}, column);
  return turn_about(select(definite, gentle, steepest), h, a);
}

FASCICLE_INLINE Turn select(Mask mask, const Turn& a, const Turn& b) {
  return {select(mask, a.w, b.w), select(mask, a.v, b.v), select(mask, a.scale, b.scale)};
}

// The turn for lanes in `active`.
FASCICLE_INLINE Turn find_turn(const LanesMatrix& s, const LanesMatrix& r, Mask active) {
  Vector m[3];
  for (int i = 0; i < 3; ++i) m[i] = {dot(s.row[i], r.row[0]), dot(s.row[i], r.row[1]), dot(s.row[i], r.row[2])};
  const Vector a{m[2].y - m[1].z, m[0].z - m[2].x, m[1].x - m[0].y};
  const SymmetricMatrix h{m[1].y + m[2].z,           m[0].x + m[2].z,           m[0].x + m[1].y,
                          -0.5f * (m[2].y + m[1].z), -0.5f * (m[0].z + m[2].x), -0.5f * (m[1].x + m[0].y)};
  const SymmetricMatrix inverse = adjugate(h);
  const Lanes det = determinant(h, inverse), one = broadcast<16>(1.0f), least = broadcast<16>(kDefinite);
  const Mask definite = (least < h.xx) & (least < inverse.zz) & (least < det);
  const Vector d = (one / det) * (inverse * a);
  const Lanes c = square_root(dot(d, d) + 1.0f);
  const Turn turn{c + 1.0f, d, one / (c * (c + 1.0f))};  // |(1 + c, d)|^2 = 2 c (1 + c)
  if (!any(active & invert(definite))) return turn;
  return select(definite, turn, find_careful_turn(h, a, m[0].x + m[1].y + m[2].z));
}

FASCICLE_INLINE LanesMatrix apply(const Turn& turn, const LanesMatrix& r) {
  const Lanes one = broadcast<16>(1.0f);
  const Vector sv = turn.scale * turn.v, w = turn.w * sv;
  const Lanes xx = sv.x * turn.v.x, yy = sv.y * turn.v.y, zz = sv.z * turn.v.z;
  const Lanes xy = sv.x * turn.v.y, xz = sv.x * turn.v.z, yz = sv.y * turn.v.z;
  const Vector by[3] = {{one - (yy + zz), xy - w.z, xz + w.y},
                        {xy + w.z, one - (xx + zz), yz - w.x},
                        {xz - w.y, yz + w.x, one - (xx + yy)}};
  LanesMatrix result;
  for (int i = 0; i < 3; ++i) result.row[i] = by[i].x * r.row[0] + by[i].y * r.row[1] + by[i].z * r.row[2];
  return result;
}

FASCICLE_INLINE Vector normalise(Vector a) { return (broadcast<16>(1.0f) / square_root(dot(a, a))) * a; }
FASCICLE_INLINE LanesMatrix make_orthogonal(const LanesMatrix& r) {
  const Vector x = normalise(r.row[0]), y = normalise(r.row[1] - dot(x, r.row[1]) * x);
  return {{x, y, cross(x, y)}};
}

FASCICLE_INLINE void fit_pack(const float* matrix, float* rotation, std::size_t iterations) {
  const Lanes zero = broadcast<16>(0.0f), one = broadcast<16>(1.0f);
  LanesMatrix s = load_matrix(matrix), start = load_matrix(rotation);
  const LanesMatrix identity{{{one, zero, zero}, {zero, one, zero}, {zero, zero, one}}};
  start = select(absolute(square_sum(start) - 3.0f) < broadcast<16>(0.5f), start, identity);
  const Lanes square = square_sum(s);
  const Mask sound = (broadcast<16>(kLeastSquare) < square) & (square < broadcast<16>(kGreatestSquare));
  const Lanes scale = one / square_root(square);
  for (Vector& row : s.row) row = scale * row;
  s = select(sound, s, start);  // of which start is the nearest
  LanesMatrix r = start;
  Mask active = sound;
  for (std::size_t i = 0; i < iterations && any(active); ++i) {
    const Turn turn = find_turn(s, r, active);
    r = select(active, apply(turn, r), r);
    // tan(t / 2) = |v| / w
    active = active & (broadcast<16>(0.25f * kSettledSquare) * (turn.w * turn.w) < dot(turn.v, turn.v));
  }
  store_matrix(select(sound, make_orthogonal(r), start), rotation);
}

inline void fit_rotations(const RotationPacks& packs) {
  for (std::size_t i = 0; i < packs.pack_count; ++i) {
    fit_pack(packs.matrices + 144 * i, packs.rotations + 144 * i, packs.iterations);
  }
}

}  // namespace fascicle::muscle::FASCICLE_ISA
