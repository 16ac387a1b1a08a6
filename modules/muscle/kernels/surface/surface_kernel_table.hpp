// The table of this source file's instruction set. Included once by each of surface_kernels_portable.cpp,
// surface_kernels_avx2.cpp and surface_kernels_avx512.cpp, which CMakeLists.txt compiles with their flags.
#pragma once

#include "modules/muscle/kernels/surface/move_points.hpp"
#include "modules/muscle/kernels/surface/project_hinges.hpp"
#include "modules/muscle/kernels/surface/project_volume.hpp"

namespace fascicle::muscle::FASCICLE_ISA {

extern const SurfaceKernelTable kSurfaceKernels;

const SurfaceKernelTable kSurfaceKernels{project_hinges, measure_hinges, project_volume,
                                         measure_volume, carry,          predict,
                                         take_velocities, fade_differences};

}  // namespace fascicle::muscle::FASCICLE_ISA
