// Joint positions beyond the range of the model.
#pragma once

namespace cellmirror::app {

// rad or m: encoders read a little beyond a limit at which the robot stands.
inline constexpr double kJointRangeTolerance = 1e-4;

// Whether a joint at `position` is outside of [lower, upper]; all three in rad or m.
[[nodiscard]] inline bool is_beyond(double position, double lower, double upper) {
  return position < lower - kJointRangeTolerance || position > upper + kJointRangeTolerance;
}

}  // namespace cellmirror::app
