// For x86-64 with AVX2 and FMA: cmake gives this file alone the flags.
#define CELLMIRROR_KERNELS avx2
#include "rt_core/ranging/cone_bounds_kernel.hpp"
