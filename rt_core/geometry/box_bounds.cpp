#include "rt_core/geometry/box_bounds.hpp"

namespace cellmirror::geometry {

ChildBounds child_bounds() noexcept {
#ifdef CELLMIRROR_AVX2_KERNELS
  static const ChildBounds chosen = __builtin_cpu_supports("avx2") != 0 && __builtin_cpu_supports("fma") != 0
                                        ? avx2::child_bounds()
                                        : baseline::child_bounds();
#else
  static const ChildBounds chosen = baseline::child_bounds();
#endif
  return chosen;
}

}  // namespace cellmirror::geometry
