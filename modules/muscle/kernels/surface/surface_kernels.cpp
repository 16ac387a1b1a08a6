#include "modules/muscle/kernels/surface/surface_kernels.hpp"

#include "modules/muscle/kernels/surface/surface_reference.hpp"

namespace fascicle::muscle {

const SurfaceKernels& surface_kernels(SimdLevel) { return surface_reference_kernels(); }

}  // namespace fascicle::muscle
