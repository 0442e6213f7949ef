// Velocity profiles of one axis or of one path: closed forms, no integration over ticks.
#pragma once

#include <array>
#include <cstddef>
#include <limits>

#include "rt_core/base/real_time.hpp"
#include "rt_core/ports/robot_parameters.hpp"

namespace cellmirror::motion {

// One change of speed, from v0 to v1 within `duration`, or a cruise where both are equal. Ramp: v is linear in time.
// Sine: v(t) = v0 + (v1 - v0) (1 - cos(pi t / duration)) / 2. Both take the same time for the same change
// (duration = |v1 - v0| / a) and cover the same way ((v0 + v1) / 2 * duration), so that every formula of a plan holds
// for both; at its steepest the sine accelerates with pi/2 * a.
struct Ramp {
  double duration = 0;  // s
  double v0 = 0;        // rad/s or m/s
  double v1 = 0;
  VelocityProfile shape = VelocityProfile::ramp;

  [[nodiscard]] double way() const CELL_RT { return 0.5 * (v0 + v1) * duration; }
  // `t` within [0, duration].
  [[nodiscard]] double way(double t) const CELL_RT;
  [[nodiscard]] double velocity(double t) const CELL_RT;
  [[nodiscard]] double acceleration(double t) const CELL_RT;
};

struct AxisLimits {
  double velocity = 0;      // of the cruise; positive; rad/s or m/s
  double acceleration = 0;  // positive; rad/s2 or m/s2
  // Where the axis may be. Braking never leads beyond: where the acceleration does not do, it is raised.
  double lower = -std::numeric_limits<double>::infinity();
  double upper = std::numeric_limits<double>::infinity();
};

// From a position and a velocity to rest at a target.
//
// An axis at rest follows the shape. A moving axis adopts its new speed with a linear ramp even in a sine profile: a
// sine begins with zero acceleration, and fast successive commands would never get beyond its beginning. An axis that
// is too fast brakes first; one that would overshoot or moves the wrong way stops and reverses. Where it would
// overshoot only because it is in the middle of a sine, which brakes late, it brakes up to pi/2 times as hard instead.
class Profile {
 public:
  Profile() = default;
  // `target` is within the limits.
  [[nodiscard]] static Profile to_target(double position, double velocity, double target, const AxisLimits& limits,
                                         VelocityProfile shape) CELL_RT;
  // To rest, as soon as the acceleration allows.
  [[nodiscard]] static Profile to_rest(double position, double velocity, const AxisLimits& limits) CELL_RT;

  // The cruising speed below `limits.velocity` with which to_target() takes `duration`, which is not shorter than with
  // `limits.velocity`. An axis that has to brake all the way cannot take longer: any speed does.
  [[nodiscard]] static double velocity_for(double duration, double position, double velocity, double target,
                                           const AxisLimits& limits, VelocityProfile shape) CELL_RT;

  // The acceleration with which an axis at rest covers `way` within `duration` at this cruising speed at most. Infinite
  // where the speed alone does not allow it.
  [[nodiscard]] static double acceleration_for(double duration, double way, double velocity) CELL_RT;

  [[nodiscard]] double duration() const CELL_RT { return duration_; }  // s
  [[nodiscard]] double target() const CELL_RT { return target_; }

  struct State {
    double position = 0;
    double velocity = 0;
    double acceleration = 0;
    bool braking_to_target = false;  // in its last change of speed, or at rest
  };
  // Before 0: as at 0; after the end: at rest exactly on the target.
  [[nodiscard]] State at(double t) const CELL_RT;

  // Its members, for a recording of the tick (rt_core/base/state_bytes.hpp).
  template <class Archive>
  void transfer(Archive& archive) CELL_RT {
    archive.bounded(count_, kMostRamps);
    archive.first(ramps_, count_);
    archive(start_, target_, duration_);
  }

 private:
  void append(double duration, double v0, double v1, VelocityProfile shape) CELL_RT;
  void append_from_rest(double way, double velocity, double acceleration, VelocityProfile shape) CELL_RT;

  static constexpr std::size_t kMostRamps = 4;  // to rest, up, cruise, down
  std::array<Ramp, kMostRamps> ramps_{};
  std::size_t count_ = 0;
  double start_ = 0;
  double target_ = 0;
  double duration_ = 0;
};

}  // namespace cellmirror::motion
