// The table of this source file's instruction set. Included once by each of mtu_kernels_portable.cpp,
// mtu_kernels_avx2.cpp and mtu_kernels_avx512.cpp, which CMakeLists.txt compiles with their flags.
#pragma once

#include "modules/muscle/kernels/build_frames.hpp"
#include "modules/muscle/kernels/find_tendons.hpp"
#include "modules/muscle/kernels/measure_volume.hpp"
#include "modules/muscle/kernels/mtu_reference.hpp"
#include "modules/muscle/kernels/place_points.hpp"
#include "modules/muscle/kernels/write_surfaces.hpp"

namespace fascicle::muscle::FASCICLE_ISA {

extern const MtuKernels kKernels;
extern const MtuKernels kReferenceKernels;

const MtuKernels kKernels{check_bones, place_points, build_frames, find_tendons, write_surfaces, measure_volume};
const MtuKernels kReferenceKernels{reference::check_bones,  reference::place_points,   reference::build_frames,
                                   reference::find_tendons, reference::write_surfaces, reference::measure_volume};

}  // namespace fascicle::muscle::FASCICLE_ISA
