#include "tools/fascicle_bench/machine_rates.hpp"

#include <immintrin.h>

#include <algorithm>
#include <array>
#include <cstddef>

#include <benchmark/benchmark.h>

#include "engine/ecs/monotonic_clock.hpp"
#include "engine/math/aligned_vector.hpp"

namespace fascicle::bench {
namespace {

constexpr int kRounds = 20000;
constexpr int kChains = 12;  // independent, so that the units and not the waiting for results decide

[[gnu::target("avx512f")]] void run_avx512() {
  __m512 a = _mm512_set1_ps(0.999f), b = _mm512_set1_ps(0.001f), x[kChains];
  for (__m512& v : x) v = b;
  for (int i = 0; i < kRounds; ++i) {
#pragma GCC unroll 12
    for (int c = 0; c < kChains; ++c) x[c] = _mm512_fmadd_ps(x[c], a, b);
  }
  for (__m512& v : x) benchmark::DoNotOptimize(v);
}

[[gnu::target("avx2,fma")]] void run_avx2() {
  __m256 a = _mm256_set1_ps(0.999f), b = _mm256_set1_ps(0.001f), x[kChains];
  for (__m256& v : x) v = b;
  for (int i = 0; i < kRounds; ++i) {
#pragma GCC unroll 12
    for (int c = 0; c < kChains; ++c) x[c] = _mm256_fmadd_ps(x[c], a, b);
  }
  for (__m256& v : x) benchmark::DoNotOptimize(v);
}

void run_portable() {
  __m128 a = _mm_set1_ps(0.999f), b = _mm_set1_ps(0.001f), x[kChains];
  for (__m128& v : x) v = b;
  for (int i = 0; i < kRounds; ++i) {
#pragma GCC unroll 12
    for (int c = 0; c < kChains; ++c) x[c] = _mm_add_ps(_mm_mul_ps(x[c], a), b);
  }
  for (__m128& v : x) benchmark::DoNotOptimize(v);
}

// The least of many short runs: others may use the machine, too.
template <class F>
double shortest_seconds(F&& f) {
  std::int64_t best = INT64_MAX;
  for (int i = 0; i < 200; ++i) {
    const std::int64_t start = monotonic_ns();
    f();
    best = std::min(best, monotonic_ns() - start);
  }
  return 1.0e-9 * static_cast<double>(best);
}

double read_bytes_per_second(std::size_t bytes) {
  const std::size_t count = bytes / sizeof(float);
  const AlignedVector<float> data(count, 1.0f);
  const double seconds = shortest_seconds([&] {
    __m128 sum[4] = {};
    for (std::size_t i = 0; i < count; i += 16) {
      for (std::size_t k = 0; k < 4; ++k) sum[k] = _mm_add_ps(sum[k], _mm_load_ps(data.data() + i + 4 * k));
    }
    for (__m128& s : sum) benchmark::DoNotOptimize(s);
  });
  return static_cast<double>(bytes) / seconds;
}

}  // namespace

double multiply_adds_per_second(SimdLevel level) {
  static std::array<double, kSimdLevelCount> known{};
  double& rate = known[static_cast<std::size_t>(level)];
  if (rate > 0.0) return rate;
  const auto run = level == SimdLevel::kAvx512 ? run_avx512 : level == SimdLevel::kAvx2 ? run_avx2 : run_portable;
  const double lanes = level == SimdLevel::kAvx512 ? 16.0 : level == SimdLevel::kAvx2 ? 8.0 : 4.0;
  rate = lanes * kChains * kRounds / shortest_seconds(run);
  return rate;
}

double second_level_bandwidth() {
  static const double rate = read_bytes_per_second(std::size_t{512} << 10);
  return rate;
}

double third_level_bandwidth() {
  static const double rate = read_bytes_per_second(std::size_t{12} << 20);
  return rate;
}

}  // namespace fascicle::bench
