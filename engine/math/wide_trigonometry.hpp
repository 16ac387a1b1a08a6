// sin, cos and atan2 of wide floats, by the polynomials of Cephes (Moshier 1989), the same on every instruction set.
// Error: below 2e-7 for sines and cosines of angles up to a thousand turns, 3e-7 rad for atan2.
#pragma once

#include "engine/math/wide_float.hpp"

namespace fascicle::FASCICLE_ISA {

// For |y| <= pi/4; there, the same bits as sine_cosine.
template <int N>
FASCICLE_INLINE void sine_cosine_near_zero(WideFloat<N> y, WideFloat<N>& sine, WideFloat<N>& cosine) {
  const WideFloat<N> z = y * y;
  sine = ((-1.9515295891e-4f * z + 8.3321608736e-3f) * z - 1.6666654611e-1f) * z * y + y;
  cosine = ((2.443315711809948e-5f * z - 1.388731625493765e-3f) * z + 4.166664568298827e-2f) * z * z - 0.5f * z + 1.0f;
}

template <int N>
FASCICLE_INLINE void sine_cosine(WideFloat<N> angle, WideFloat<N>& sine, WideFloat<N>& cosine) {
  // angle = quarter pi/2 + y, |y| <= pi/4; pi/2 in three parts whose products with `quarter` are exact.
  const WideInt<N> quarter = round_to_int(0.63661977236758134f * angle);
  const WideFloat<N> q = to_float(quarter);
  const WideFloat<N> y = angle - 1.5703125f * q - 4.837512969970703125e-4f * q - 7.54978995489188216e-8f * q;
  WideFloat<N> s, c;
  sine_cosine_near_zero(y, s, c);
  const WideInt<N> odd = (quarter & broadcast_int<N>(1)) == broadcast_int<N>(1);
  const WideInt<N> sine_sign = shift_left(quarter & broadcast_int<N>(2), 30);
  const WideInt<N> cosine_sign = shift_left((quarter + broadcast_int<N>(1)) & broadcast_int<N>(2), 30);
  sine = from_bits(bits_of(select(odd, c, s)) ^ sine_sign);
  cosine = from_bits(bits_of(select(odd, s, c)) ^ cosine_sign);
}

// atan2(0, 0) is 0.
template <int N>
FASCICLE_INLINE WideFloat<N> arc_tangent(WideFloat<N> y, WideFloat<N> x) {
  const WideFloat<N> zero = broadcast<N>(0.0f);
  const WideFloat<N> ax = absolute(x), ay = absolute(y);
  const WideFloat<N> large = maximum(ax, ay), small = minimum(ax, ay);
  const WideFloat<N> ratio = small / select(zero < large, large, broadcast<N>(1.0f));
  const WideInt<N> steep = broadcast<N>(0.41421356237f) < ratio;  // tan(pi/8)
  const WideFloat<N> a = select(steep, (ratio - 1.0f) / (ratio + 1.0f), ratio);
  const WideFloat<N> z = a * a;
  WideFloat<N> angle = (((8.05374449538e-2f * z - 1.38776856032e-1f) * z + 1.99777106478e-1f) * z -
                        3.33329491539e-1f) * z * a + a;
  angle = select(steep, angle + 0.785398163397448f, angle);
  angle = select(ax < ay, broadcast<N>(1.5707963267948966f) - angle, angle);
  angle = select(x < zero, broadcast<N>(3.1415926535897932f) - angle, angle);
  return from_bits(bits_of(angle) | (bits_of(y) & broadcast_int<N>(static_cast<int>(0x80000000u))));
}

}  // namespace fascicle::FASCICLE_ISA
