// For every processor.
#define CELLMIRROR_KERNELS baseline
#include "rt_core/ranging/cone_bounds_kernel.hpp"
