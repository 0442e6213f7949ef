// For every processor of the architecture.
#define CELLMIRROR_KERNELS baseline
#include "rt_core/kinematics/forward_kernel.hpp"
