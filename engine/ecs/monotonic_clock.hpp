// The clock all timings of the project are taken with.
#pragma once

#include <chrono>
#include <cstdint>

namespace fascicle {

// Nanoseconds since some fixed moment; never goes back. Takes about 20 ns.
inline std::int64_t monotonic_ns() {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(std::chrono::steady_clock::now().time_since_epoch())
      .count();
}

}  // namespace fascicle
