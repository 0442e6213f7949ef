// Estimates velocities and accelerations of joints.
#pragma once

#include <array>
#include <cstddef>
#include <span>

#include "rt_core/base/capacity.hpp"
#include "rt_core/base/real_time.hpp"
#include "rt_core/base/time.hpp"
#include "rt_core/ports/robot_parameters.hpp"

namespace cellmirror::dynamics {

// A value that follows its input with a time constant, and how fast it does: the derivative of the input behind a
// first-order low-pass, (1 - exp(-dt / tau)) (input - value) / dt.
class FilteredDerivative {
 public:
  void reset(double value) CELL_RT {
    value_ = value;
    rate_ = 0;
  }
  // `dt` and `time_constant` above zero.
  double update(double input, double dt, double time_constant) CELL_RT;
  [[nodiscard]] double rate() const CELL_RT { return rate_; }

 private:
  double value_ = 0;
  double rate_ = 0;
};

// Of one robot. Accelerations are filtered derivatives of velocities. Velocities are those of the source; for a source
// of positions only (every velocity was zero so far) they are filtered derivatives of positions.
class MotionEstimate {
 public:
  // The time constant of both filters, or twice the time between two samples where that is longer.
  static constexpr double kTimeConstant = 0.02;  // s
  static constexpr double kLongestGap = 0.25;    // s, between samples; after it the filters restart
  static constexpr double kJump = 0.5;           // rad or m, between samples: no motion

  // A sample: the same instant again changes nothing, an earlier one or another number of joints restarts the filters.
  // `differences`: derive velocities from positions as long as the source has given none.
  void take(Timestamp time, std::span<const double> position, std::span<const double> velocity,
            bool differences) CELL_RT;
  // The motion is unknown and counts as standing still. Forgets whether velocities were given.
  void stand_still() CELL_RT;

  [[nodiscard]] const JointValues& velocity() const CELL_RT { return velocity_; }
  [[nodiscard]] const JointValues& acceleration() const CELL_RT { return acceleration_; }

 private:
  void begin(Timestamp time, std::span<const double> position, std::span<const double> velocity) CELL_RT;

  Timestamp time_;
  std::size_t joints_ = 0;
  bool velocities_given_ = false;
  JointValues position_{};  // of the newest sample
  JointValues velocity_{};
  JointValues acceleration_{};
  std::array<FilteredDerivative, kMaxJointsPerRobot> of_position_{};
  std::array<FilteredDerivative, kMaxJointsPerRobot> of_velocity_{};
};

}  // namespace cellmirror::dynamics
