// The coarse hull's kernels in plain scalar code, in double precision: what the wide ones are tested against and
// measured by. The nearest rotation is found anew, wherever R starts: it is Horn's, the greatest eigenvector of his 4 x
// 4 matrix of S (1987), so where several are equally near it may be another one.
#pragma once

#include "modules/muscle/kernels/hull/hull_kernels.hpp"

namespace fascicle::muscle {

const HullKernels& hull_reference_kernels();

}  // namespace fascicle::muscle
