// The constraints of surface muscles in plain scalar code, hinge after hinge: what the wide kernels are tested against
// and measured by. Same equations, same order of hinges; only sums and angles round differently.
#pragma once

#include "modules/muscle/kernels/surface/surface_kernels.hpp"

namespace fascicle::muscle {

const SurfaceKernels& surface_reference_kernels();

}  // namespace fascicle::muscle
