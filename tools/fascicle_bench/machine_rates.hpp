// What one thread of this machine can do at most, measured beside the benchmarks that are compared with it.
#pragma once

#include "engine/math/simd_level.hpp"

namespace fascicle::bench {

// Floating-point multiply-adds a second, of floats, by the widest registers of a level that the processor has; at the
// portable level, which has none fused, a multiplication and an addition. Measured once.
double multiply_adds_per_second(SimdLevel level);

// Bytes a second read from an array of half a MiB, which lies in a second-level cache. Measured once.
double second_level_bandwidth();

// Of 12 MiB: in a third-level cache, or in memory.
double third_level_bandwidth();

}  // namespace fascicle::bench
