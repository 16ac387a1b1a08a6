#include "modules/muscle/kernels/hull/hull_kernels.hpp"

#include <algorithm>
#include <cassert>

#include "modules/muscle/kernels/hull/hull_kernel_data.hpp"

namespace fascicle::muscle {

namespace portable {
extern const HullKernelTable kHullKernels;
}
namespace avx2 {
extern const HullKernelTable kHullKernels;
}
namespace avx512 {
extern const HullKernelTable kHullKernels;
}

namespace {

// The jobs' spans become the pointers that the tables take.
template <const HullKernelTable& kTable>
struct Wrapped {
  static void multiply(const ProductJob& job) {
    if (job.matrix == nullptr) return;
    assert(job.in.size() >= job.matrix->columns && job.out.size() >= job.matrix->rows);
    kTable.multiply({.values = job.matrix->values.data(),
                     .rows = job.matrix->rows,
                     .columns = job.matrix->columns,
                     .in = reinterpret_cast<const float*>(job.in.data()),
                     .out = reinterpret_cast<float*>(job.out.data()),
                     .add = job.add});
  }
  static void fit_rotations(const RotationJob& job) {
    assert(job.matrices.size() == job.rotations.size());
    if (job.matrices.empty()) return;
    kTable.fit_rotations({.matrices = job.matrices.front().value.front().data(),
                          .rotations = job.rotations.front().value.front().data(),
                          .pack_count = std::min(job.matrices.size(), job.rotations.size()),
                          .iterations = job.iterations});
  }
  static void solve_factor(const FactorJob& job) {
    if (job.factor == nullptr || job.factor->size == 0) return;
    const SparseFactor& factor = *job.factor;
    assert(job.x.size() >= factor.size && factor.first.size() == factor.size + 1);
    kTable.solve_factor({.size = factor.size,
                         .first = factor.first.data(),
                         .row = factor.row.data(),
                         .value = factor.value.data(),
                         .x = job.x.front().value.data()});
  }
  static constexpr HullKernels kKernels{multiply, fit_rotations, solve_factor};
};

}  // namespace

const HullKernels& hull_kernels(SimdLevel level) {
  const SimdLevel best = detect_simd();
  switch (level < best ? level : best) {
    case SimdLevel::kAvx512: return Wrapped<avx512::kHullKernels>::kKernels;
    case SimdLevel::kAvx2: return Wrapped<avx2::kHullKernels>::kKernels;
    case SimdLevel::kPortable: break;
  }
  return Wrapped<portable::kHullKernels>::kKernels;
}

}  // namespace fascicle::muscle
