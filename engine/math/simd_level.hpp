// Which vector instructions the kernels use. The level is chosen at run time, by the caller or from the processor;
// all levels give the same results bit for bit (see wide_float.hpp), so it is a matter of speed alone.
#pragma once

#include <optional>
#include <string_view>

namespace fascicle {

enum class SimdLevel {
  kPortable,  // x86-64-v2: SSE4.2, the baseline that the whole program needs
  kAvx2,
  kAvx512,    // F, VL, DQ and BW
};
inline constexpr int kSimdLevelCount = 3;

// The highest level that this processor and its operating system offer.
SimdLevel detect_simd();

// "portable", "avx2", "avx512".
std::string_view to_string(SimdLevel level);

// The level of that name, or nothing.
std::optional<SimdLevel> parse_simd_level(std::string_view name);

}  // namespace fascicle
