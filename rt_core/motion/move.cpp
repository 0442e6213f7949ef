#include "rt_core/motion/move.hpp"

#include <cmath>

namespace cellmirror::motion {

namespace {

bool positive(double value) CELL_RT { return std::isfinite(value) && value > 0; }

bool not_negative(double value) CELL_RT { return std::isfinite(value) && value >= 0; }

bool sound_joints(const Move& move, std::size_t joints) CELL_RT {
  for (std::size_t i = 0; i < joints; ++i) {
    if (!std::isfinite(move.target[i]) || !positive(move.velocity[i]) || !positive(move.acceleration[i])) return false;
  }
  return not_negative(move.fly_parameter);
}

bool sound_path(const Move& move, std::size_t joints) CELL_RT {
  constexpr double kRotationSlack = 1e-6;
  for (std::size_t i = 0; i < joints; ++i) {
    if (!not_negative(move.min_velocity[i]) || !not_negative(move.acceleration[i])) return false;
  }
  const Eigen::Matrix3d R = move.X_BG.linear();
  return move.X_BG.matrix().allFinite() && (R * R.transpose()).isIdentity(kRotationSlack) && R.determinant() > 0 &&
         positive(move.linear_velocity) && positive(move.linear_acceleration) && positive(move.rotational_velocity) &&
         positive(move.rotational_acceleration) && not_negative(move.fly_parameter);
}

}  // namespace

bool is_sound(const Move& move, std::size_t joints) CELL_RT {
  if (move.kind == MoveKind::delay) return not_negative(move.delay_s);
  for (std::size_t i = 0; i < joints; ++i) {
    if (!positive(move.max_velocity[i])) return false;
  }
  if (move.kind == MoveKind::joints) return sound_joints(move, joints);
  if (move.kind == MoveKind::circular && !move.p_BV.allFinite()) return false;
  return (move.kind == MoveKind::linear || move.kind == MoveKind::circular) && sound_path(move, joints);
}

}  // namespace cellmirror::motion
