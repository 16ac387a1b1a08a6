// Points -> cross-section frames (1.2), 16 muscles side by side, because each muscle's frames are a chain.
//
// The tangent is t_k = normalize(a_{k+1} - a_{k-1}), one-sided at the ends. The direction u_k is carried from section
// to section without turning about the line, by the double reflection of Wang et al. (2008): reflect u and t in the
// plane between a_k and a_{k+1}, then in the plane that takes the reflected t to t_{k+1}. It starts from the origin's
// bone: its rest tangent and u_0, turned by the bone, carried onto t_0 by the shortest arc. (Projecting the bone's u_0
// onto the section instead breaks down when the line swings by a right angle, as hip muscles do; the shortest arc
// does only at half a turn.) The insertion's bone carries a direction the same way; the angle from u to it is the
// muscle's twist, zero at rest, unwrapped against the last frame, and spread over the sections by arc length.
//
// A muscle that is attached to an area has an end section that lies on it: its tangent is fixed in the bone as well.
//
// Steps too short to have a direction, hairpins and reversals keep the previous direction, so that no lane ever divides
// by zero. Lanes that end early repeat their last section.
// For the kernels' source files only (see engine/math/wide_float.hpp).
#pragma once

#include "engine/math/wide_float.hpp"
#include "engine/math/wide_trigonometry.hpp"
#include "modules/muscle/kernels/mtu_kernels.hpp"
#include "modules/muscle/kernels/place_points.hpp"

namespace fascicle::muscle::FASCICLE_ISA {

// Squared length (m^2) below which a step has no direction: 10 micrometres, a few roundings at 10 m from the origin.
inline constexpr float kShortestStepSquared = 1.0e-10f;
// Squared sine below which a chord is too square to the tangent for a reflection to be meaningful (84 degrees).
inline constexpr float kSquareChord = 0.01f;
// Squared length of t' - t_L below which the second reflection is left out.
inline constexpr float kSameTangent = 1.0e-8f;

template <int N>
FASCICLE_INLINE WideVector<N> normalized(WideVector<N> a) {
  return (broadcast<N>(1.0f) / square_root(dot(a, a))) * a;
}

// Squared length below which a bone's direction has vanished: the bone's matrix is singular.
inline constexpr float kVanishedSquared = 1.0e-20f;

// The direction of `a`, or the x axis.
template <int N>
FASCICLE_INLINE WideVector<N> direction_of(WideVector<N> a) {
  const WideFloat<N> zero = broadcast<N>(0.0f), one = broadcast<N>(1.0f);
  const WideFloat<N> squared = dot(a, a);
  const WideInt<N> good = broadcast<N>(kVanishedSquared) < squared;
  return select(good, (one / square_root(select(good, squared, one))) * a, WideVector<N>{one, zero, zero});
}

// The direction of `a` square to the unit vector `t`, or any other.
template <int N>
FASCICLE_INLINE WideVector<N> square_direction_of(WideVector<N> a, WideVector<N> t) {
  const WideFloat<N> zero = broadcast<N>(0.0f), one = broadcast<N>(1.0f);
  a = a - dot(a, t) * t;
  const WideFloat<N> squared = dot(a, a);
  const WideInt<N> good = broadcast<N>(kVanishedSquared) < squared;
  const WideInt<N> steep = absolute(t.x) < broadcast<N>(0.7f);
  const WideVector<N> axis = select(steep, WideVector<N>{one, zero, zero}, WideVector<N>{zero, one, zero});
  return normalized(select(good, (one / square_root(select(good, squared, one))) * a, axis - dot(axis, t) * t));
}

// `r`, square to `t`, carried to the tangent `next_t` along `step`, of squared length `length_squared`; along no step:
// by the shortest arc. The chain from r to the result is two dot products long: everything else can be computed ahead.
template <int N>
FASCICLE_INLINE WideVector<N> carry(WideVector<N> r, WideVector<N> t, WideVector<N> step, WideFloat<N> length_squared,
                                    WideVector<N> next_t) {
  const WideFloat<N> one = broadcast<N>(1.0f), two = broadcast<N>(2.0f);
  const WideFloat<N> along = dot(step, t);
  const WideInt<N> usable = (broadcast<N>(kShortestStepSquared) < length_squared) &
                            (kSquareChord * length_squared < along * along);
  const WideVector<N> mirror = select(usable, step, t);
  const WideFloat<N> k1 = two / select(usable, length_squared, one);
  const WideVector<N> r_reflected = r - (k1 * dot(mirror, r)) * mirror;
  const WideVector<N> t_reflected = t - (k1 * select(usable, along, one)) * mirror;
  const WideVector<N> second = next_t - t_reflected;
  const WideFloat<N> second_squared = dot(second, second);
  const WideInt<N> turns = broadcast<N>(kSameTangent) < second_squared;
  const WideFloat<N> k2 = two / select(turns, second_squared, one);
  return select(turns, r_reflected - (k2 * dot(second, r_reflected)) * second, r_reflected);
}

// `r` made exactly square to `t` and unit, which it is but for rounding: a step of Newton's method does for the length.
template <int N>
FASCICLE_INLINE WideVector<N> square_up(WideVector<N> r, WideVector<N> t) {
  const WideVector<N> u = r - dot(r, t) * t;
  return (broadcast<N>(1.5f) - 0.5f * dot(u, u)) * u;
}

struct LaneDirections {
  alignas(64) float x[kLanes], y[kLanes], z[kLanes];
};
struct LaneMask {
  alignas(64) std::int32_t lanes[kLanes];  // -1 or 0
};

template <int N>
FASCICLE_INLINE WideVector<N> load_directions(const LaneDirections& from) {
  return {load<N>(from.x), load<N>(from.y), load<N>(from.z)};
}

// The end frames of a block's lanes, turned by their bones.
FASCICLE_INLINE void turn_ends(const float* bones, const EndFrame* ends, LaneDirections* tangents,
                               LaneDirections* references, LaneMask* fixed) {
  for (int end = 0; end < 2; ++end) {
    for (std::uint32_t lane = 0; lane < kLanes; lane += 4) {
      __m128 t[4], u[4];
      for (std::uint32_t i = 0; i < 4; ++i) {
        const EndFrame& frame = ends[2 * (lane + i) + static_cast<std::uint32_t>(end)];
        t[i] = transform(bones + 16 * frame.bone, frame.tangent).v;
        u[i] = transform(bones + 16 * frame.bone, frame.reference).v;
        fixed[end].lanes[lane + i] = frame.fixed != 0 ? -1 : 0;
      }
      _MM_TRANSPOSE4_PS(t[0], t[1], t[2], t[3]);
      _MM_TRANSPOSE4_PS(u[0], u[1], u[2], u[3]);
      store(WideFloat<4>{t[0]}, tangents[end].x + lane);
      store(WideFloat<4>{t[1]}, tangents[end].y + lane);
      store(WideFloat<4>{t[2]}, tangents[end].z + lane);
      store(WideFloat<4>{u[0]}, references[end].x + lane);
      store(WideFloat<4>{u[1]}, references[end].y + lane);
      store(WideFloat<4>{u[2]}, references[end].z + lane);
    }
  }
}

// Stores `value`, except in held lanes.
template <bool kHold, int N>
FASCICLE_INLINE void store_free(WideFloat<N> value, WideInt<N> held, float* to) {
  if constexpr (kHold) value = select(held, load<N>(to), value);
  store(value, to);
}

template <bool kHold>
inline void build_block(const BuildFramesJob& job, std::size_t block_index) {
  constexpr int N = kLanes;
  using Float = WideFloat<N>;
  using Int = WideInt<N>;
  using Vector = WideVector<N>;
  const LaneBlock& block = job.blocks[block_index];
  const std::size_t first = block.first_slot;
  const std::size_t lane = block_index * kLanes;
  const Float zero = broadcast<N>(0.0f), one = broadcast<N>(1.0f);
  const WideInt<N> counts = load_int<N>(block.counts);
  const WideInt<N> held = kHold ? load_int<N>(job.held + lane) : broadcast_int<N>(0);
  const auto point = [&](std::size_t k) __attribute__((always_inline)) {
    const std::size_t slot = first + kLanes * k;
    return Vector{load<N>(job.x + slot), load<N>(job.y + slot), load<N>(job.z + slot)};
  };

  LaneDirections tangents[2], references[2];
  LaneMask fixed_lanes[2];
  turn_ends(job.bones, job.ends + 2 * lane, tangents, references, fixed_lanes);
  const WideInt<N> origin_fixed = load_int<N>(fixed_lanes[0].lanes);
  const WideInt<N> insertion_fixed = load_int<N>(fixed_lanes[1].lanes);
  const bool any_fixed = any(origin_fixed) || any(insertion_fixed);
  const Vector end_t = direction_of(load_directions<N>(tangents[1]));

  // Along the line: tangents, carried directions, arc length.
  Vector t = direction_of(load_directions<N>(tangents[0]));
  Vector r = square_direction_of(load_directions<N>(references[0]), t);
  Vector before = point(0), here = before, step{zero, zero, zero}, u = r;
  Float arc = zero, step_squared = zero;
  for (std::uint32_t k = 0; k < block.height; ++k) {
    const std::size_t slot = first + kLanes * std::size_t{k};
    Vector next = here;
    if (k + 1 < block.height) {
      next = select(broadcast_int<N>(static_cast<int>(k + 1)) < counts, point(k + 1), here);
    }
    const Vector chord = next - before;
    const Float chord_squared = dot(chord, chord);
    const WideInt<N> has_direction = broadcast<N>(kShortestStepSquared) < chord_squared;
    const Float inverse = one / square_root(select(has_direction, chord_squared, one));
    Vector next_t = select(has_direction, inverse * chord, t);
    if (any_fixed) {
      if (k == 0) next_t = select(origin_fixed, t, next_t);
      const Int here_last = broadcast_int<N>(static_cast<int>(k)) < counts;
      const Int next_last = broadcast_int<N>(static_cast<int>(k + 1)) < counts;
      next_t = select(insertion_fixed & (here_last ^ next_last), end_t, next_t);
    }
    r = carry(r, t, step, step_squared, next_t);
    t = next_t;
    u = square_up(r, t);
    const Vector v = cross(t, u);
    store_free<kHold>(u.x, held, job.ux + slot);
    store_free<kHold>(u.y, held, job.uy + slot);
    store_free<kHold>(u.z, held, job.uz + slot);
    store_free<kHold>(v.x, held, job.vx + slot);
    store_free<kHold>(v.y, held, job.vy + slot);
    store_free<kHold>(v.z, held, job.vz + slot);
    store_free<kHold>(arc, held, job.arc + slot);
    step = next - here;
    step_squared = dot(step, step);
    arc = arc + square_root(step_squared);
    before = here;
    here = next;
  }

  // The twist at the insertion.
  const Vector end_r = square_direction_of(load_directions<N>(references[1]), end_t);
  const Vector wanted = square_up(carry(end_r, end_t, Vector{zero, zero, zero}, zero, t), t);
  Float twist = arc_tangent(dot(cross(t, u), wanted), dot(u, wanted));
  const Float last = job.restart_twist ? zero : load<N>(job.twist + lane);
  twist = twist + 6.2831853071795865f * to_float(round_to_int(0.15915494309189534f * (last - twist)));
  store_free<kHold>(twist, held, job.twist + lane);

  // Spread over the sections.
  const WideInt<N> has_length = broadcast<N>(1.0e-5f) < arc;
  Float rate = select(has_length, twist / select(has_length, arc, one), zero);
  if constexpr (kHold) rate = select(held, zero, rate);
  const bool far_twisted = any(broadcast<N>(0.75f) < absolute(twist));
  for (std::uint32_t k = 0; k < block.height; ++k) {
    const std::size_t slot = first + kLanes * std::size_t{k};
    const Vector u_k{load<N>(job.ux + slot), load<N>(job.uy + slot), load<N>(job.uz + slot)};
    const Vector v_k{load<N>(job.vx + slot), load<N>(job.vy + slot), load<N>(job.vz + slot)};
    Float sine, cosine;
    const Float angle = rate * load<N>(job.arc + slot);
    if (far_twisted) sine_cosine(angle, sine, cosine);
    else sine_cosine_near_zero(angle, sine, cosine);
    const Vector turned_u = cosine * u_k + sine * v_k;
    const Vector turned_v = cosine * v_k - sine * u_k;
    store(turned_u.x, job.ux + slot);
    store(turned_u.y, job.uy + slot);
    store(turned_u.z, job.uz + slot);
    store(turned_v.x, job.vx + slot);
    store(turned_v.y, job.vy + slot);
    store(turned_v.z, job.vz + slot);
  }
}

inline void build_frames(const BuildFramesJob& job) {
  for (std::size_t block = 0; block < job.block_count; ++block) {
    if (job.held == nullptr) build_block<false>(job, block);
    else build_block<true>(job, block);
  }
}

}  // namespace fascicle::muscle::FASCICLE_ISA
