#include "rt_core/ranging/cone_bounds.hpp"

namespace cellmirror::ranging {

const ConeKernels& cone_kernels() noexcept {
#ifdef CELLMIRROR_AVX2_KERNELS
  static const ConeKernels chosen = __builtin_cpu_supports("avx2") != 0 && __builtin_cpu_supports("fma") != 0
                                        ? avx2::cone_kernels()
                                        : baseline::cone_kernels();
#else
  static const ConeKernels chosen = baseline::cone_kernels();
#endif
  return chosen;
}

}  // namespace cellmirror::ranging
