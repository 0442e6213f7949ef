// For every processor.
#define CELLMIRROR_KERNELS baseline
#include "rt_core/geometry/box_bounds_kernel.hpp"
