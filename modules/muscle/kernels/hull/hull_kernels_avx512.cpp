#include "modules/muscle/kernels/hull/hull_kernel_table.hpp"
