#include "modules/muscle/kernels/surface/surface_kernel_table.hpp"
