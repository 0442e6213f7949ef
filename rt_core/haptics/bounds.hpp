// Bounds of what workers give to the tick: beyond them a number is a mistake, and its square may be none.
#pragma once

#include <Eigen/Core>

#include "rt_core/base/real_time.hpp"

namespace cellmirror::haptics {

inline constexpr double kFarthestPlace = 1e4;  // m: no place of a cell is farther away

// Finite, and no component larger than `most`.
inline bool is_bounded(const Eigen::Vector3d& v, double most) CELL_RT {
  return v.allFinite() && v.cwiseAbs().maxCoeff() <= most;
}

}  // namespace cellmirror::haptics
