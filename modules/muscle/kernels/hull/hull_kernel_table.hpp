// The table of this source file's instruction set. Included once by each of hull_kernels_portable.cpp,
// hull_kernels_avx2.cpp and hull_kernels_avx512.cpp, which CMakeLists.txt compiles with their flags.
#pragma once

#include "modules/muscle/kernels/hull/fit_rotations.hpp"
#include "modules/muscle/kernels/hull/multiply_rows.hpp"
#include "modules/muscle/kernels/hull/solve_factor.hpp"

namespace fascicle::muscle::FASCICLE_ISA {

extern const HullKernelTable kHullKernels;

const HullKernelTable kHullKernels{multiply_rows, fit_rotations, solve_factor};

}  // namespace fascicle::muscle::FASCICLE_ISA
