#include "rt_core/geometry/box_bounds.hpp"

namespace cellmirror::geometry {

const BoxKernels& box_kernels() noexcept {
#ifdef CELLMIRROR_AVX2_KERNELS
  static const BoxKernels chosen = __builtin_cpu_supports("avx2") != 0 && __builtin_cpu_supports("fma") != 0
                                       ? avx2::box_kernels()
                                       : baseline::box_kernels();
#else
  static const BoxKernels chosen = baseline::box_kernels();
#endif
  return chosen;
}

}  // namespace cellmirror::geometry
