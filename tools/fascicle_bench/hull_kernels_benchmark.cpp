// The coarse hull's inner loops (4.5), by the sizes of the muscles at hand:
//
//   hull_multiply/ROWSxCOLUMNS/LEVEL    a dense matrix times x, y and z; the largest also from memory: `_cold` takes
//                                       another of eight copies each time
//   hull_rotations/ITERATIONS/LEVEL     the nearest rotations of 9,878 matrices, 17 degrees away at first; `settled`:
//                                       from where they are
//   hull_factor/LEVEL                   eight right-hand sides by the sparse factor of a bending energy on a closed
//                                       mesh of 9,880 vertices, ordered by least degree
//
// `_reference` is the plain code, compiled with the same flags, in double precision. GB and GFLOP are a second, M_each
// millions of matrices a second; beside them is what the machine does at most, by the same clock: L2_GB, L3_GB (12 MiB
// read in order) and GFMA, multiply-adds, two operations each, of which these kernels use none fused.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Sparse>

#include "modules/muscle/kernels/hull/hull_reference.hpp"
#include "tools/fascicle_bench/machine_rates.hpp"

namespace {

using namespace fascicle;
using namespace fascicle::muscle;

const HullKernels& kernels_of(SimdLevel level, bool reference) {
  return reference ? hull_reference_kernels() : hull_kernels(level);
}

void count(benchmark::State& state, SimdLevel level, double bytes, double operations) {
  using benchmark::Counter;
  const double times = 1.0e-9 * static_cast<double>(state.iterations());
  state.counters["GB"] = Counter(times * bytes, Counter::kIsRate);
  state.counters["GFLOP"] = Counter(times * operations, Counter::kIsRate);
  state.counters["GFMA"] = 1.0e-9 * bench::multiply_adds_per_second(level);
  state.counters["L2_GB"] = 1.0e-9 * bench::second_level_bandwidth();
  state.counters["L3_GB"] = 1.0e-9 * bench::third_level_bandwidth();
}

void multiply(benchmark::State& state, std::uint32_t rows, std::uint32_t columns, std::size_t copies, SimdLevel level,
              bool reference) {
  std::mt19937 random(1);
  std::uniform_real_distribution<float> any(-1.0f, 1.0f);
  DenseRows matrix = make_dense_rows(rows, columns);
  for (float& value : matrix.values) value = any(random);
  const std::vector<DenseRows> matrices(copies, matrix);
  const AlignedVector<SurfacePoint> in(columns, {any(random), any(random), any(random), 1.0f});
  AlignedVector<SurfacePoint> out(rows);
  const HullKernels& kernels = kernels_of(level, reference);
  std::size_t i = 0;
  for (auto _ : state) {
    kernels.multiply({.matrix = &matrices[i++ % copies], .in = in, .out = out});
    benchmark::ClobberMemory();
  }
  const double entries = static_cast<double>(rows) * columns;
  count(state, level, 4.0 * entries, 6.0 * entries);
}

void rotations(benchmark::State& state, std::uint32_t iterations, bool settled, SimdLevel level, bool reference) {
  std::mt19937 random(1);
  std::normal_distribution<float> any(0.0f, 0.17f);
  std::vector<MatrixPack> matrices((9878 + kPanelRows - 1) / kPanelRows), starts(matrices.size());
  for (std::size_t i = 0; i < matrices.size(); ++i) {
    for (std::size_t k = 0; k < 9; ++k) {
      for (float& value : matrices[i].value[k]) value = (k == 0 ? 1.0f : k == 4 ? 0.8f : 0.0f) + any(random);
      starts[i].value[k].fill(k % 4 == 0 ? 1.0f : 0.0f);
    }
  }
  const HullKernels& kernels = kernels_of(level, reference);
  if (settled) kernels.fit_rotations({.matrices = matrices, .rotations = starts, .iterations = 20});
  std::vector<MatrixPack> fitted = starts;
  for (auto _ : state) {
    std::copy(starts.begin(), starts.end(), fitted.begin());
    kernels.fit_rotations({.matrices = matrices, .rotations = fitted, .iterations = iterations});
    benchmark::ClobberMemory();
  }
  const double each = static_cast<double>(16 * matrices.size()) * static_cast<double>(state.iterations());
  state.counters["M_each"] = benchmark::Counter(1.0e-6 * each, benchmark::Counter::kIsRate);
}

// The square of the Laplacian of a torus of 95 x 104 vertices with six neighbours each, some held.
const SparseFactor& find_factor() {
  static const SparseFactor factor = [] {
    constexpr int kWide = 95, kLong = 104, kCount = kWide * kLong;
    std::vector<Eigen::Triplet<double>> entries;
    for (int i = 0; i < kCount; ++i) {
      const auto at = [&](int x, int y) {
        return (i % kWide + x + kWide) % kWide + kWide * ((i / kWide + y + kLong) % kLong);
      };
      for (const int other : {at(1, 0), at(-1, 0), at(0, 1), at(0, -1), at(1, 1), at(-1, -1)}) {
        entries.emplace_back(i, other, -1.0);
      }
      entries.emplace_back(i, i, 6.0);
    }
    Eigen::SparseMatrix<double> laplacian(kCount, kCount), held(kCount, kCount);
    laplacian.setFromTriplets(entries.begin(), entries.end());
    held.setIdentity();
    const Eigen::SparseMatrix<double> energy = laplacian * laplacian + 0.01 * held;
    const Eigen::SimplicialLLT<Eigen::SparseMatrix<double>> llt(energy);
    const Eigen::SparseMatrix<double> l = llt.matrixL();
    SparseFactor result;
    result.size = kCount;
    for (int j = 0; j < kCount; ++j) {
      result.first.push_back(static_cast<std::uint32_t>(result.row.size()));
      for (Eigen::SparseMatrix<double>::InnerIterator entry(l, j); entry; ++entry) {
        result.row.push_back(static_cast<std::uint32_t>(entry.row()));
        result.value.push_back(static_cast<float>(entry.row() == j ? 1.0 / entry.value() : entry.value()));
      }
    }
    result.first.push_back(static_cast<std::uint32_t>(result.row.size()));
    return result;
  }();
  return factor;
}

void substitute(benchmark::State& state, SimdLevel level, bool reference) {
  const SparseFactor& factor = find_factor();
  std::vector<EightColumns> right(factor.size), x;
  for (std::size_t i = 0; i < right.size(); ++i) {
    for (std::size_t k = 0; k < 8; ++k) right[i].value[k] = std::sin(static_cast<float>(i * k));
  }
  const HullKernels& kernels = kernels_of(level, reference);
  for (auto _ : state) {
    x = right;
    kernels.solve_factor({.factor = &factor, .x = x});
    benchmark::ClobberMemory();
  }
  const double entries = static_cast<double>(factor.value.size());
  count(state, level, 2.0 * 4.0 * entries, 2.0 * 16.0 * entries);  // the entries, both ways, of values alone
  state.counters["M_entries"] = 1.0e-6 * entries;
}

void add_all() {
  const SimdLevel best = detect_simd();
  const auto on_levels = [&](const std::string& title, const std::string& what, auto&& add) {
    for (const bool reference : {false, true}) {
      for (const SimdLevel level : {SimdLevel::kPortable, SimdLevel::kAvx2, SimdLevel::kAvx512}) {
        if (level > best || (reference && level != SimdLevel::kPortable)) continue;
        const std::string name =
            reference ? title + "_reference" + what : title + what + "/" + std::string(to_string(level));
        add(name.c_str(), level, reference)->Unit(benchmark::kMicrosecond);
      }
    }
  };
  struct Size {
    std::uint32_t rows, columns;
  };
  for (const auto& [rows, columns] : {Size{900, 300}, {300, 900}, {300, 1500}, {1500, 300}, {9878, 300}}) {
    const std::string what = "/" + std::to_string(rows) + "x" + std::to_string(columns);
    for (const std::size_t copies : {1, 8}) {
      if (copies > 1 && rows < 9878) continue;
      on_levels(copies > 1 ? "hull_multiply_cold" : "hull_multiply", what,
                [&](const char* name, SimdLevel level, bool reference) {
                  return benchmark::RegisterBenchmark(name, multiply, rows, columns, copies, level, reference);
                });
    }
  }
  for (const auto& [what, iterations] : {std::pair{"/1", 1u}, {"/2", 2u}, {"/4", 4u}, {"/settled", 4u}}) {
    const bool settled = what[1] == 's';
    on_levels("hull_rotations", what, [&](const char* name, SimdLevel level, bool reference) {
      return benchmark::RegisterBenchmark(name, rotations, iterations, settled, level, reference);
    });
  }
  on_levels("hull_factor", "", [&](const char* name, SimdLevel level, bool reference) {
    return benchmark::RegisterBenchmark(name, substitute, level, reference);
  });
}

[[maybe_unused]] const bool kRegistered = (add_all(), true);

}  // namespace
