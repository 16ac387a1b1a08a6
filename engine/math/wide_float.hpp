// The one SIMD type: WideFloat<N>, N = 4, 8 or 16 floats side by side, with WideInt<N> for masks and bit patterns.
//
// A source file that includes this is compiled for one instruction set (see kernels_*.cpp and their flags in
// CMakeLists.txt), and everything here lives in a namespace named after it, so that no function compiled for AVX can be
// linked into code that must run without. For the same reason such a file calls no inline function of another library
// (std, glm). N is logical: on a narrower machine a WideFloat is two halves, recursively, so that a kernel reads the
// same on all of them.
//
// All instruction sets give the same bits. Hence only operations that IEEE 754 defines exactly: + - * / sqrt and
// comparisons; no fused multiply-add (-ffp-contract=off), no reciprocal estimates; and no sum across lanes, whose order
// would depend on the width: store and add in order (see sum_in_order).
#pragma once

#include <immintrin.h>

#if defined(__AVX512F__) && defined(__AVX512VL__) && defined(__AVX512DQ__) && defined(__AVX512BW__)
#define FASCICLE_ISA avx512
#elif defined(__AVX2__)
#define FASCICLE_ISA avx2
#else
#define FASCICLE_ISA portable
#endif
#define FASCICLE_INLINE [[gnu::always_inline]] inline

namespace fascicle::FASCICLE_ISA {

#if defined(__AVX512F__)
inline constexpr int kNativeLanes = 16;
#elif defined(__AVX2__)
inline constexpr int kNativeLanes = 8;
#else
inline constexpr int kNativeLanes = 4;
#endif

// The compiler's vectors of N elements: they have the arithmetic and comparison operators.
template <int N>
struct Register {
  typedef float Float __attribute__((vector_size(N * 4)));
  typedef int Int __attribute__((vector_size(N * 4)));
  typedef unsigned Bits __attribute__((vector_size(N * 4)));
};

template <int N, bool kNative = (N <= kNativeLanes)>
struct WideFloat {
  typename Register<N>::Float v;
};
template <int N>
struct WideFloat<N, false> {
  WideFloat<N / 2> lo, hi;
};

// A mask's lanes are all ones (true) or all zeros.
template <int N, bool kNative = (N <= kNativeLanes)>
struct WideInt {
  typename Register<N>::Int v;
};
template <int N>
struct WideInt<N, false> {
  WideInt<N / 2> lo, hi;
};

template <int N>
inline constexpr bool kIsNative = N <= kNativeLanes;

// --- Making, loading, storing. `load` and `store` take any address that is aligned for a float.

template <int N>
FASCICLE_INLINE WideFloat<N> broadcast(float value) {
  if constexpr (!kIsNative<N>) {
    return {broadcast<N / 2>(value), broadcast<N / 2>(value)};
  } else {
    return {typename Register<N>::Float{} + value};
  }
}

template <int N>
FASCICLE_INLINE WideInt<N> broadcast_int(int value) {
  if constexpr (!kIsNative<N>) {
    return {broadcast_int<N / 2>(value), broadcast_int<N / 2>(value)};
  } else {
    return {typename Register<N>::Int{} + value};
  }
}

template <int N>
FASCICLE_INLINE WideFloat<N> load(const float* from) {
  if constexpr (!kIsNative<N>) {
    return {load<N / 2>(from), load<N / 2>(from + N / 2)};
  } else {
    WideFloat<N> result;
    __builtin_memcpy(&result.v, from, sizeof(result.v));
    return result;
  }
}

template <int N>
FASCICLE_INLINE WideInt<N> load_int(const int* from) {
  if constexpr (!kIsNative<N>) {
    return {load_int<N / 2>(from), load_int<N / 2>(from + N / 2)};
  } else {
    WideInt<N> result;
    __builtin_memcpy(&result.v, from, sizeof(result.v));
    return result;
  }
}

template <int N>
FASCICLE_INLINE void store(WideFloat<N> a, float* to) {
  if constexpr (!kIsNative<N>) {
    store(a.lo, to);
    store(a.hi, to + N / 2);
  } else {
    __builtin_memcpy(to, &a.v, sizeof(a.v));
  }
}

template <int N>
FASCICLE_INLINE void store_int(WideInt<N> a, int* to) {
  if constexpr (!kIsNative<N>) {
    store_int(a.lo, to);
    store_int(a.hi, to + N / 2);
  } else {
    __builtin_memcpy(to, &a.v, sizeof(a.v));
  }
}

// --- Arithmetic.

template <int N>
FASCICLE_INLINE WideFloat<N> operator+(WideFloat<N> a, WideFloat<N> b) {
  if constexpr (!kIsNative<N>) return {a.lo + b.lo, a.hi + b.hi};
  else return {a.v + b.v};
}
template <int N>
FASCICLE_INLINE WideFloat<N> operator-(WideFloat<N> a, WideFloat<N> b) {
  if constexpr (!kIsNative<N>) return {a.lo - b.lo, a.hi - b.hi};
  else return {a.v - b.v};
}
template <int N>
FASCICLE_INLINE WideFloat<N> operator*(WideFloat<N> a, WideFloat<N> b) {
  if constexpr (!kIsNative<N>) return {a.lo * b.lo, a.hi * b.hi};
  else return {a.v * b.v};
}
template <int N>
FASCICLE_INLINE WideFloat<N> operator/(WideFloat<N> a, WideFloat<N> b) {
  if constexpr (!kIsNative<N>) return {a.lo / b.lo, a.hi / b.hi};
  else return {a.v / b.v};
}
template <int N>
FASCICLE_INLINE WideFloat<N> operator*(float a, WideFloat<N> b) { return broadcast<N>(a) * b; }
template <int N>
FASCICLE_INLINE WideFloat<N> operator+(WideFloat<N> a, float b) { return a + broadcast<N>(b); }
template <int N>
FASCICLE_INLINE WideFloat<N> operator-(WideFloat<N> a, float b) { return a - broadcast<N>(b); }

template <int N>
FASCICLE_INLINE WideFloat<N> square_root(WideFloat<N> a) {
  if constexpr (!kIsNative<N>) return {square_root(a.lo), square_root(a.hi)};
  else if constexpr (N == 4) return {_mm_sqrt_ps(a.v)};
#if defined(__AVX2__)
  else if constexpr (N == 8) return {_mm256_sqrt_ps(a.v)};
#endif
#if defined(__AVX512F__)
  else if constexpr (N == 16) return {_mm512_sqrt_ps(a.v)};
#endif
}

// --- Comparisons, masks and bits.

template <int N>
FASCICLE_INLINE WideInt<N> operator<(WideFloat<N> a, WideFloat<N> b) {
  if constexpr (!kIsNative<N>) return {a.lo < b.lo, a.hi < b.hi};
  else return {a.v < b.v};
}
template <int N>
FASCICLE_INLINE WideInt<N> operator<=(WideFloat<N> a, WideFloat<N> b) {
  if constexpr (!kIsNative<N>) return {a.lo <= b.lo, a.hi <= b.hi};
  else return {a.v <= b.v};
}
template <int N>
FASCICLE_INLINE WideInt<N> operator<(WideInt<N> a, WideInt<N> b) {
  if constexpr (!kIsNative<N>) return {a.lo < b.lo, a.hi < b.hi};
  else return {a.v < b.v};
}
template <int N>
FASCICLE_INLINE WideInt<N> operator==(WideInt<N> a, WideInt<N> b) {
  if constexpr (!kIsNative<N>) return {a.lo == b.lo, a.hi == b.hi};
  else return {a.v == b.v};
}
template <int N>
FASCICLE_INLINE WideInt<N> operator&(WideInt<N> a, WideInt<N> b) {
  if constexpr (!kIsNative<N>) return {a.lo & b.lo, a.hi & b.hi};
  else return {a.v & b.v};
}
template <int N>
FASCICLE_INLINE WideInt<N> operator|(WideInt<N> a, WideInt<N> b) {
  if constexpr (!kIsNative<N>) return {a.lo | b.lo, a.hi | b.hi};
  else return {a.v | b.v};
}
template <int N>
FASCICLE_INLINE WideInt<N> operator^(WideInt<N> a, WideInt<N> b) {
  if constexpr (!kIsNative<N>) return {a.lo ^ b.lo, a.hi ^ b.hi};
  else return {a.v ^ b.v};
}
template <int N>
FASCICLE_INLINE WideInt<N> operator+(WideInt<N> a, WideInt<N> b) {
  if constexpr (!kIsNative<N>) return {a.lo + b.lo, a.hi + b.hi};
  else return {a.v + b.v};
}
template <int N>
FASCICLE_INLINE WideInt<N> operator-(WideInt<N> a, WideInt<N> b) {
  if constexpr (!kIsNative<N>) return {a.lo - b.lo, a.hi - b.hi};
  else return {a.v - b.v};
}
template <int N>
FASCICLE_INLINE WideInt<N> shift_left(WideInt<N> a, int bits) {
  if constexpr (!kIsNative<N>) return {shift_left(a.lo, bits), shift_left(a.hi, bits)};
  else return {a.v << bits};
}

// Zeros come in at the top.
template <int N>
FASCICLE_INLINE WideInt<N> shift_right(WideInt<N> a, int bits) {
  if constexpr (!kIsNative<N>) return {shift_right(a.lo, bits), shift_right(a.hi, bits)};
  else return {(typename Register<N>::Int)((typename Register<N>::Bits)a.v >> bits)};
}

// mask ? a : b, lane by lane.
template <int N>
FASCICLE_INLINE WideFloat<N> select(WideInt<N> mask, WideFloat<N> a, WideFloat<N> b) {
  if constexpr (!kIsNative<N>) return {select(mask.lo, a.lo, b.lo), select(mask.hi, a.hi, b.hi)};
  else return {mask.v ? a.v : b.v};
}
template <int N>
FASCICLE_INLINE WideInt<N> select(WideInt<N> mask, WideInt<N> a, WideInt<N> b) {
  if constexpr (!kIsNative<N>) return {select(mask.lo, a.lo, b.lo), select(mask.hi, a.hi, b.hi)};
  else return {mask.v ? a.v : b.v};
}

// Whether the mask is true in any lane.
template <int N>
FASCICLE_INLINE bool any(WideInt<N> mask) {
  if constexpr (!kIsNative<N>) return any(mask.lo | mask.hi);
  else if constexpr (N == 4) return _mm_movemask_ps((__m128)mask.v) != 0;
#if defined(__AVX2__)
  else if constexpr (N == 8) return _mm256_movemask_ps((__m256)mask.v) != 0;
#endif
#if defined(__AVX512F__)
  else if constexpr (N == 16) return _mm512_movepi32_mask((__m512i)mask.v) != 0;
#endif
}

template <int N>
FASCICLE_INLINE WideInt<N> bits_of(WideFloat<N> a) {
  if constexpr (!kIsNative<N>) return {bits_of(a.lo), bits_of(a.hi)};
  else return {(typename Register<N>::Int)a.v};
}
template <int N>
FASCICLE_INLINE WideFloat<N> from_bits(WideInt<N> a) {
  if constexpr (!kIsNative<N>) return {from_bits(a.lo), from_bits(a.hi)};
  else return {(typename Register<N>::Float)a.v};
}

template <int N>
FASCICLE_INLINE WideFloat<N> absolute(WideFloat<N> a) {
  return from_bits(bits_of(a) & broadcast_int<N>(0x7fffffff));
}
// scale / sqrt(a) to a part in 40,000, for a > 0; finite, not infinite, where a = 0. The guess y halves the exponent by
// integer arithmetic, t = a y^2 then lies within [0.906, 1.033], and the quadratic is the best one for 1 / sqrt(t) there.
// A third of the time of a root and a quotient, and plain products, so the same bits on every processor.
template <int N>
FASCICLE_INLINE WideFloat<N> inverse_root(WideFloat<N> a, float scale) {
  const WideFloat<N> y = from_bits(broadcast_int<N>(0x5f340000) - shift_right(bits_of(a), 1));
  const WideFloat<N> t = (a * y) * y;
  const WideFloat<N> slope = broadcast<N>(-1.31355764f * scale) + (0.40677785f * scale) * t;
  return y * (broadcast<N>(1.90675837f * scale) + slope * t);
}

// Like std::min and std::max: the first where the comparison fails.
template <int N>
FASCICLE_INLINE WideFloat<N> minimum(WideFloat<N> a, WideFloat<N> b) { return select(b < a, b, a); }
template <int N>
FASCICLE_INLINE WideFloat<N> maximum(WideFloat<N> a, WideFloat<N> b) { return select(a < b, b, a); }

// To the nearest integer, ties to even.
template <int N>
FASCICLE_INLINE WideInt<N> round_to_int(WideFloat<N> a) {
  if constexpr (!kIsNative<N>) return {round_to_int(a.lo), round_to_int(a.hi)};
  else if constexpr (N == 4) return {(typename Register<N>::Int)_mm_cvtps_epi32(a.v)};
#if defined(__AVX2__)
  else if constexpr (N == 8) return {(typename Register<N>::Int)_mm256_cvtps_epi32(a.v)};
#endif
#if defined(__AVX512F__)
  else if constexpr (N == 16) return {(typename Register<N>::Int)_mm512_cvtps_epi32(a.v)};
#endif
}
template <int N>
FASCICLE_INLINE WideFloat<N> to_float(WideInt<N> a) {
  if constexpr (!kIsNative<N>) return {to_float(a.lo), to_float(a.hi)};
  else return {__builtin_convertvector(a.v, typename Register<N>::Float)};
}

// Eight lanes turned by one place: lane i of rotate_down is lane i + 1 of `a`, of rotate_up lane i - 1.
FASCICLE_INLINE WideFloat<8> rotate_down(WideFloat<8> a) {
#if defined(__AVX2__)
  return {_mm256_permutevar8x32_ps(a.v, _mm256_setr_epi32(1, 2, 3, 4, 5, 6, 7, 0))};
#else
  const __m128i lo = _mm_castps_si128(a.lo.v), hi = _mm_castps_si128(a.hi.v);
  return {{_mm_castsi128_ps(_mm_alignr_epi8(hi, lo, 4))}, {_mm_castsi128_ps(_mm_alignr_epi8(lo, hi, 4))}};
#endif
}
FASCICLE_INLINE WideFloat<8> rotate_up(WideFloat<8> a) {
#if defined(__AVX2__)
  return {_mm256_permutevar8x32_ps(a.v, _mm256_setr_epi32(7, 0, 1, 2, 3, 4, 5, 6))};
#else
  const __m128i lo = _mm_castps_si128(a.lo.v), hi = _mm_castps_si128(a.hi.v);
  return {{_mm_castsi128_ps(_mm_alignr_epi8(lo, hi, 12))}, {_mm_castsi128_ps(_mm_alignr_epi8(hi, lo, 12))}};
#endif
}

// The lanes' sum, first to last whatever the machine.
template <int N>
FASCICLE_INLINE float sum_in_order(WideFloat<N> a) {
  float lanes[N];
  store(a, lanes);
  float sum = lanes[0];
  for (int i = 1; i < N; ++i) sum += lanes[i];
  return sum;
}

// --- Writing N records of four floats, x y z w each, from four registers: the transpose of the lanes. With kStream
// past the caches; `to` must then be aligned to 32 bytes.

FASCICLE_INLINE void store_four(float* to, __m128 a, bool stream) {
  if (stream) _mm_stream_ps(to, a);
  else _mm_storeu_ps(to, a);
}

template <bool kStream>
FASCICLE_INLINE void store_records(WideFloat<4> x, WideFloat<4> y, WideFloat<4> z, WideFloat<4> w, float* to) {
  __m128 a = x.v, b = y.v, c = z.v, d = w.v;
  _MM_TRANSPOSE4_PS(a, b, c, d);
  store_four(to, a, kStream);
  store_four(to + 4, b, kStream);
  store_four(to + 8, c, kStream);
  store_four(to + 12, d, kStream);
}

#if defined(__AVX2__)
FASCICLE_INLINE void store_eight(float* to, __m256 a, bool stream) {
  if (stream) _mm256_stream_ps(to, a);
  else _mm256_storeu_ps(to, a);
}

template <bool kStream>
FASCICLE_INLINE void store_records(WideFloat<8> x, WideFloat<8> y, WideFloat<8> z, WideFloat<8> w, float* to) {
  const __m256 xy_lo = _mm256_unpacklo_ps(x.v, y.v), xy_hi = _mm256_unpackhi_ps(x.v, y.v);
  const __m256 zw_lo = _mm256_unpacklo_ps(z.v, w.v), zw_hi = _mm256_unpackhi_ps(z.v, w.v);
  const __m256 r04 = _mm256_shuffle_ps(xy_lo, zw_lo, 0x44), r15 = _mm256_shuffle_ps(xy_lo, zw_lo, 0xee);
  const __m256 r26 = _mm256_shuffle_ps(xy_hi, zw_hi, 0x44), r37 = _mm256_shuffle_ps(xy_hi, zw_hi, 0xee);
  store_eight(to, _mm256_permute2f128_ps(r04, r15, 0x20), kStream);
  store_eight(to + 8, _mm256_permute2f128_ps(r26, r37, 0x20), kStream);
  store_eight(to + 16, _mm256_permute2f128_ps(r04, r15, 0x31), kStream);
  store_eight(to + 24, _mm256_permute2f128_ps(r26, r37, 0x31), kStream);
}
#endif

#if defined(__AVX512F__)
template <bool kStream>
FASCICLE_INLINE void store_sixteen(float* to, __m512 a) {
  if constexpr (kStream) {  // 64-byte streaming stores would need records aligned to 64
    _mm256_stream_ps(to, _mm512_castps512_ps256(a));
    _mm256_stream_ps(to + 8, _mm512_extractf32x8_ps(a, 1));
  } else {
    _mm512_storeu_ps(to, a);
  }
}

template <bool kStream>
FASCICLE_INLINE void store_records(WideFloat<16> x, WideFloat<16> y, WideFloat<16> z, WideFloat<16> w, float* to) {
  const __m512 xy_lo = _mm512_unpacklo_ps(x.v, y.v), xy_hi = _mm512_unpackhi_ps(x.v, y.v);
  const __m512 zw_lo = _mm512_unpacklo_ps(z.v, w.v), zw_hi = _mm512_unpackhi_ps(z.v, w.v);
  const __m512 r0 = _mm512_shuffle_ps(xy_lo, zw_lo, 0x44), r1 = _mm512_shuffle_ps(xy_lo, zw_lo, 0xee);
  const __m512 r2 = _mm512_shuffle_ps(xy_hi, zw_hi, 0x44), r3 = _mm512_shuffle_ps(xy_hi, zw_hi, 0xee);
  const __m512 a = _mm512_shuffle_f32x4(r0, r1, 0x44), b = _mm512_shuffle_f32x4(r2, r3, 0x44);
  const __m512 c = _mm512_shuffle_f32x4(r0, r1, 0xee), d = _mm512_shuffle_f32x4(r2, r3, 0xee);
  store_sixteen<kStream>(to, _mm512_shuffle_f32x4(a, b, 0x88));
  store_sixteen<kStream>(to + 16, _mm512_shuffle_f32x4(a, b, 0xdd));
  store_sixteen<kStream>(to + 32, _mm512_shuffle_f32x4(c, d, 0x88));
  store_sixteen<kStream>(to + 48, _mm512_shuffle_f32x4(c, d, 0xdd));
}
#endif

template <bool kStream, int N>
  requires(!kIsNative<N>)
FASCICLE_INLINE void store_records(WideFloat<N> x, WideFloat<N> y, WideFloat<N> z, WideFloat<N> w, float* to) {
  store_records<kStream>(x.lo, y.lo, z.lo, w.lo, to);
  store_records<kStream>(x.hi, y.hi, z.hi, w.hi, to + N / 2 * 4);
}

// --- Records of four floats at places of their own: lane i is the record `index[i]`, whose address must be aligned to
// 16 bytes. 128-bit loads and stores and transposes: the processors' own gathers take a float at a time.

template <int N>
struct WideRecord {
  WideFloat<N> x, y, z, w;
};

FASCICLE_INLINE __m128 load_record(const float* records, const int* index, int lane) {
  return _mm_load_ps(records + 4 * static_cast<long>(index[lane]));
}

#if defined(__AVX512F__)
FASCICLE_INLINE __m256 join_two(__m128 a, __m128 b) {
  return _mm256_mask_broadcast_f32x4(_mm256_castps128_ps256(a), 0xf0, b);  // half the time of an insertion
}
#elif defined(__AVX2__)
FASCICLE_INLINE __m256 join_two(__m128 a, __m128 b) { return _mm256_insertf128_ps(_mm256_castps128_ps256(a), b, 1); }
#endif

template <int N>
FASCICLE_INLINE WideRecord<N> load_records(const float* records, const int* index) {
  if constexpr (!kIsNative<N>) {
    const WideRecord<N / 2> lo = load_records<N / 2>(records, index), hi = load_records<N / 2>(records, index + N / 2);
    return {{lo.x, hi.x}, {lo.y, hi.y}, {lo.z, hi.z}, {lo.w, hi.w}};
  } else if constexpr (N == 4) {
    __m128 a = load_record(records, index, 0), b = load_record(records, index, 1);
    __m128 c = load_record(records, index, 2), d = load_record(records, index, 3);
    _MM_TRANSPOSE4_PS(a, b, c, d);
    return {{a}, {b}, {c}, {d}};
#if defined(__AVX2__)
  } else if constexpr (N == 8) {
    __m256 row[4];  // of lanes i and i + 4
    for (int i = 0; i < 4; ++i) {
      row[i] = join_two(load_record(records, index, i), load_record(records, index, i + 4));
    }
    const __m256 xy_lo = _mm256_unpacklo_ps(row[0], row[1]), zw_lo = _mm256_unpackhi_ps(row[0], row[1]);
    const __m256 xy_hi = _mm256_unpacklo_ps(row[2], row[3]), zw_hi = _mm256_unpackhi_ps(row[2], row[3]);
    return {{_mm256_shuffle_ps(xy_lo, xy_hi, 0x44)}, {_mm256_shuffle_ps(xy_lo, xy_hi, 0xee)},
            {_mm256_shuffle_ps(zw_lo, zw_hi, 0x44)}, {_mm256_shuffle_ps(zw_lo, zw_hi, 0xee)}};
#endif
#if defined(__AVX512F__)
  } else {
    __m512 row[4];  // of lanes i, i + 4, i + 8 and i + 12
    for (int i = 0; i < 4; ++i) {
      const __m256 lo = join_two(load_record(records, index, i), load_record(records, index, i + 4));
      const __m256 hi = join_two(load_record(records, index, i + 8), load_record(records, index, i + 12));
      row[i] = _mm512_insertf32x8(_mm512_castps256_ps512(lo), hi, 1);
    }
    const __m512 xy_lo = _mm512_unpacklo_ps(row[0], row[1]), zw_lo = _mm512_unpackhi_ps(row[0], row[1]);
    const __m512 xy_hi = _mm512_unpacklo_ps(row[2], row[3]), zw_hi = _mm512_unpackhi_ps(row[2], row[3]);
    return {{_mm512_shuffle_ps(xy_lo, xy_hi, 0x44)}, {_mm512_shuffle_ps(xy_lo, xy_hi, 0xee)},
            {_mm512_shuffle_ps(zw_lo, zw_hi, 0x44)}, {_mm512_shuffle_ps(zw_lo, zw_hi, 0xee)}};
#endif
  }
}

FASCICLE_INLINE void store_record(float* records, const int* index, int lane, __m128 record) {
  _mm_store_ps(records + 4 * static_cast<long>(index[lane]), record);
}

template <int N>
FASCICLE_INLINE void store_records_at(WideRecord<N> a, float* records, const int* index) {
  if constexpr (!kIsNative<N>) {
    store_records_at<N / 2>({a.x.lo, a.y.lo, a.z.lo, a.w.lo}, records, index);
    store_records_at<N / 2>({a.x.hi, a.y.hi, a.z.hi, a.w.hi}, records, index + N / 2);
  } else if constexpr (N == 4) {
    __m128 x = a.x.v, y = a.y.v, z = a.z.v, w = a.w.v;
    _MM_TRANSPOSE4_PS(x, y, z, w);
    store_record(records, index, 0, x);
    store_record(records, index, 1, y);
    store_record(records, index, 2, z);
    store_record(records, index, 3, w);
#if defined(__AVX2__)
  } else if constexpr (N == 8) {
    const __m256 xy_lo = _mm256_unpacklo_ps(a.x.v, a.y.v), xy_hi = _mm256_unpackhi_ps(a.x.v, a.y.v);
    const __m256 zw_lo = _mm256_unpacklo_ps(a.z.v, a.w.v), zw_hi = _mm256_unpackhi_ps(a.z.v, a.w.v);
    const __m256 row[4] = {_mm256_shuffle_ps(xy_lo, zw_lo, 0x44), _mm256_shuffle_ps(xy_lo, zw_lo, 0xee),
                           _mm256_shuffle_ps(xy_hi, zw_hi, 0x44), _mm256_shuffle_ps(xy_hi, zw_hi, 0xee)};
    for (int i = 0; i < 4; ++i) {
      store_record(records, index, i, _mm256_castps256_ps128(row[i]));
      store_record(records, index, i + 4, _mm256_extractf128_ps(row[i], 1));
    }
#endif
#if defined(__AVX512F__)
  } else {
    const __m512 xy_lo = _mm512_unpacklo_ps(a.x.v, a.y.v), xy_hi = _mm512_unpackhi_ps(a.x.v, a.y.v);
    const __m512 zw_lo = _mm512_unpacklo_ps(a.z.v, a.w.v), zw_hi = _mm512_unpackhi_ps(a.z.v, a.w.v);
    const __m512 row[4] = {_mm512_shuffle_ps(xy_lo, zw_lo, 0x44), _mm512_shuffle_ps(xy_lo, zw_lo, 0xee),
                           _mm512_shuffle_ps(xy_hi, zw_hi, 0x44), _mm512_shuffle_ps(xy_hi, zw_hi, 0xee)};
    for (int i = 0; i < 4; ++i) {
      const __m256 lo = _mm512_castps512_ps256(row[i]), hi = _mm512_extractf32x8_ps(row[i], 1);
      store_record(records, index, i, _mm256_castps256_ps128(lo));
      store_record(records, index, i + 4, _mm256_extractf128_ps(lo, 1));
      store_record(records, index, i + 8, _mm256_castps256_ps128(hi));
      store_record(records, index, i + 12, _mm256_extractf128_ps(hi, 1));
    }
#endif
  }
}

// --- N floats as N / 4 records side by side.

// Every record's floats in another order: the i-th of the answer is number (kOrder >> 2 i) & 3.
inline constexpr int kYzxw = 0xc9, kAllW = 0xff, kYxwz = 0xb1, kZwxy = 0x4e;
template <int kOrder, int N>
FASCICLE_INLINE WideFloat<N> reorder(WideFloat<N> a) {
  if constexpr (!kIsNative<N>) return {reorder<kOrder>(a.lo), reorder<kOrder>(a.hi)};
  else if constexpr (N == 4) return {_mm_shuffle_ps(a.v, a.v, kOrder)};
#if defined(__AVX2__)
  else if constexpr (N == 8) return {_mm256_permute_ps(a.v, kOrder)};
#endif
#if defined(__AVX512F__)
  else if constexpr (N == 16) return {_mm512_permute_ps(a.v, kOrder)};
#endif
}

// Two floats of every record of `a`, then two of `b`, chosen likewise.
inline constexpr int kFirstTwo = 0x44, kLastTwo = 0xee, kEven = 0x88, kOdd = 0xdd;
template <int kOrder, int N>
FASCICLE_INLINE WideFloat<N> join(WideFloat<N> a, WideFloat<N> b) {
  if constexpr (!kIsNative<N>) return {join<kOrder>(a.lo, b.lo), join<kOrder>(a.hi, b.hi)};
  else if constexpr (N == 4) return {_mm_shuffle_ps(a.v, b.v, kOrder)};
#if defined(__AVX2__)
  else if constexpr (N == 8) return {_mm256_shuffle_ps(a.v, b.v, kOrder)};
#endif
#if defined(__AVX512F__)
  else if constexpr (N == 16) return {_mm512_shuffle_ps(a.v, b.v, kOrder)};
#endif
}

// One record everywhere, from any address; and N / 4 records at addresses of their own.
template <int N>
FASCICLE_INLINE WideFloat<N> repeat_record(const float* record) {
  if constexpr (!kIsNative<N>) return {repeat_record<N / 2>(record), repeat_record<N / 2>(record)};
  else if constexpr (N == 4) return {_mm_loadu_ps(record)};
#if defined(__AVX2__)
  else if constexpr (N == 8) return {_mm256_broadcast_ps(reinterpret_cast<const __m128*>(record))};
#endif
#if defined(__AVX512F__)
  else if constexpr (N == 16) return {_mm512_broadcast_f32x4(_mm_loadu_ps(record))};
#endif
}
FASCICLE_INLINE WideFloat<16> join_records(const float* a, const float* b, const float* c, const float* d) {
#if defined(__AVX512F__)
  const __m256 lo = join_two(_mm_loadu_ps(a), _mm_loadu_ps(b)), hi = join_two(_mm_loadu_ps(c), _mm_loadu_ps(d));
  return {_mm512_insertf32x8(_mm512_castps256_ps512(lo), hi, 1)};
#elif defined(__AVX2__)
  return {{join_two(_mm_loadu_ps(a), _mm_loadu_ps(b))}, {join_two(_mm_loadu_ps(c), _mm_loadu_ps(d))}};
#else
  return {{{_mm_loadu_ps(a)}, {_mm_loadu_ps(b)}}, {{_mm_loadu_ps(c)}, {_mm_loadu_ps(d)}}};
#endif
}

// Four times four unsigned numbers of 16 bits, from any addresses.
FASCICLE_INLINE WideInt<16> join_shorts(const void* a, const void* b, const void* c, const void* d) {
  const auto load_four = [](const void* from) { return _mm_cvtepu16_epi32(_mm_loadl_epi64((const __m128i*)from)); };
  const __m128 records[4] = {_mm_castsi128_ps(load_four(a)), _mm_castsi128_ps(load_four(b)),
                             _mm_castsi128_ps(load_four(c)), _mm_castsi128_ps(load_four(d))};
#if defined(__AVX512F__)
  const __m256 lo = join_two(records[0], records[1]), hi = join_two(records[2], records[3]);
  return bits_of(WideFloat<16>{_mm512_insertf32x8(_mm512_castps256_ps512(lo), hi, 1)});
#elif defined(__AVX2__)
  return bits_of(WideFloat<16>{{join_two(records[0], records[1])}, {join_two(records[2], records[3])}});
#else
  return bits_of(WideFloat<16>{{{records[0]}, {records[1]}}, {{records[2]}, {records[3]}}});
#endif
}

// --- Three of them, as vectors in space.

template <int N>
struct WideVector {
  WideFloat<N> x, y, z;
};
template <int N>
FASCICLE_INLINE WideVector<N> operator+(WideVector<N> a, WideVector<N> b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
template <int N>
FASCICLE_INLINE WideVector<N> operator-(WideVector<N> a, WideVector<N> b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
template <int N>
FASCICLE_INLINE WideVector<N> operator*(WideFloat<N> s, WideVector<N> a) { return {s * a.x, s * a.y, s * a.z}; }
template <int N>
FASCICLE_INLINE WideFloat<N> dot(WideVector<N> a, WideVector<N> b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
template <int N>
FASCICLE_INLINE WideVector<N> cross(WideVector<N> a, WideVector<N> b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
template <int N>
FASCICLE_INLINE WideVector<N> select(WideInt<N> mask, WideVector<N> a, WideVector<N> b) {
  return {select(mask, a.x, b.x), select(mask, a.y, b.y), select(mask, a.z, b.z)};
}

}  // namespace fascicle::FASCICLE_ISA
