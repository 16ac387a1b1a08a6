#include "modules/muscle/kernels/mtu_kernel_table.hpp"
