#include "modules/muscle/kernels/mtu_kernels.hpp"

namespace fascicle::muscle {

namespace portable {
extern const MtuKernels kKernels, kReferenceKernels;
}
namespace avx2 {
extern const MtuKernels kKernels, kReferenceKernels;
}
namespace avx512 {
extern const MtuKernels kKernels, kReferenceKernels;
}

const MtuKernels& mtu_kernels(SimdLevel level) {
  switch (level) {
    case SimdLevel::kAvx512: return avx512::kKernels;
    case SimdLevel::kAvx2: return avx2::kKernels;
    case SimdLevel::kPortable: break;
  }
  return portable::kKernels;
}

const MtuKernels& mtu_reference_kernels(SimdLevel level) {
  switch (level) {
    case SimdLevel::kAvx512: return avx512::kReferenceKernels;
    case SimdLevel::kAvx2: return avx2::kReferenceKernels;
    case SimdLevel::kPortable: break;
  }
  return portable::kReferenceKernels;
}

}  // namespace fascicle::muscle
