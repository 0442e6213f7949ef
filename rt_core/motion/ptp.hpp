// Point to point: every axis by its own profile. Belongs to the tick thread.
#pragma once

#include <array>
#include <cstddef>
#include <span>

#include "rt_core/base/real_time.hpp"
#include "rt_core/motion/move.hpp"
#include "rt_core/motion/profile.hpp"

namespace cellmirror::motion {

// Where the joints may be [rad or m]; infinite for continuous joints.
struct JointRange {
  std::span<const double> lower;
  std::span<const double> upper;
};

class PtpMotion {
 public:
  // From the posture `q` with the velocities `qd` to move.target, which lies within the range.
  void start(const Move& move, std::span<const double> q, std::span<const double> qd, const JointRange& range) CELL_RT;
  // To rest; each axis at its own acceleration.
  void brake(std::span<const double> q, std::span<const double> qd, const JointRange& range) CELL_RT;
  // To rest, all axes within the time of the slowest, so that the direction stays. An acceleration of 0: within a tenth
  // of a second.
  void brake_together(const JointValues& acceleration, std::span<const double> q, std::span<const double> qd,
                      const JointRange& range) CELL_RT;
  // `dt` seconds on. True when it stands at its end.
  bool advance(double dt, std::span<double> q, std::span<double> qd) CELL_RT;

  [[nodiscard]] double duration() const CELL_RT { return duration_; }  // s; of the slowest axis
  [[nodiscard]] const Profile& axis(std::size_t joint) const CELL_RT { return axes_[joint]; }

 private:
  void set_duration(std::size_t joints) CELL_RT;

  std::array<Profile, kMaxJointsPerRobot> axes_{};
  JointValues acceleration_{};
  double duration_ = 0;
  double t_ = 0;
};

}  // namespace cellmirror::motion
