// One float from memory in all lanes. A load, where broadcast() of a value that is not known beforehand is an addition
// (to 0, for -0's sake) and a shuffle besides.
// For the kernels' source files only (see engine/math/wide_float.hpp).
#pragma once

#include "engine/math/wide_float.hpp"

namespace fascicle::muscle::FASCICLE_ISA {

using namespace fascicle::FASCICLE_ISA;

template <int N>
FASCICLE_INLINE WideFloat<N> repeat(const float* value) {
  if constexpr (!kIsNative<N>) {
    const WideFloat<N / 2> half = repeat<N / 2>(value);
    return {half, half};
  } else if constexpr (N == 4) {
    return {_mm_set1_ps(*value)};
#if defined(__AVX2__)
  } else if constexpr (N == 8) {
    return {_mm256_broadcast_ss(value)};
#endif
#if defined(__AVX512F__)
  } else {
    return {_mm512_set1_ps(*value)};
#endif
  }
}

}  // namespace fascicle::muscle::FASCICLE_ISA
