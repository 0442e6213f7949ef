// Point to point: every axis by its own profile. Belongs to the tick thread.
#pragma once

#include <array>
#include <cstddef>
#include <span>

#include "rt_core/base/pose.hpp"
#include "rt_core/base/real_time.hpp"
#include "rt_core/kinematics/chain.hpp"
#include "rt_core/motion/move.hpp"
#include "rt_core/motion/pace.hpp"
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
  // After start() from rest: the same in a time shorter by `lag` s, or as much of it as accelerations up to
  // kHardestCatchUp times its own make possible. Gives what it gained, s.
  double catch_up(const Move& move, double lag, std::span<const double> q, const JointRange& range) CELL_RT;
  // After start(): where the next move may begin, by the move's fly type and parameter. `chain` (null: no fly point by
  // distance or angle) lives as long as the motion.
  void set_fly_point(const Move& move, const kinematics::Chain* chain) CELL_RT;
  // To rest; each axis at its own acceleration.
  void brake(std::span<const double> q, std::span<const double> qd, const JointRange& range) CELL_RT;
  // To rest, all axes within the time of the slowest, so that the direction stays. An acceleration of 0: within a tenth
  // of a second.
  void brake_together(const JointValues& acceleration, std::span<const double> q, std::span<const double> qd,
                      const JointRange& range) CELL_RT;
  // `dt` seconds on. True when it is at rest at its end.
  bool advance(double dt, std::span<double> q, std::span<double> qd) CELL_RT;

  // Whether the robot, which is in the posture `q` after the last advance(), has come to the fly point.
  [[nodiscard]] bool at_fly_point(std::span<const double> q) const CELL_RT;
  // How the pace of its time may change while it has the value `pace`: no axis is accelerated more than it may be.
  [[nodiscard]] PaceChange pace_change(double pace, std::size_t joints) const CELL_RT;

  [[nodiscard]] double duration() const CELL_RT { return duration_; }  // s; of the slowest axis
  // How long ago it ended, where it has, s.
  [[nodiscard]] double overrun() const CELL_RT { return t_ > duration_ ? t_ - duration_ : 0; }
  [[nodiscard]] const kinematics::Chain* chain() const CELL_RT { return chain_; }  // of the fly point
  [[nodiscard]] const Profile& axis(std::size_t joint) const CELL_RT { return axes_[joint]; }

  // Its members for a recording of the tick (rt_core/base/state_bytes.hpp), those of the axes for `joints` of them.
  template <class Archive>
  void transfer(Archive& archive, std::size_t joints) CELL_RT {
    archive.first(axes_, joints);
    archive.first(cruise_, joints);
    archive.first(acceleration_, joints);
    archive.choice(fly_type_, FlyType::angle);
    archive.reference(chain_);
    archive(fly_parameter_, X_BG_, duration_, t_);
  }

 private:
  void set_duration(std::size_t joints) CELL_RT;
  void plan(const Move& move, std::span<const double> q, std::span<const double> qd, const JointRange& range) CELL_RT;

  std::array<Profile, kMaxJointsPerRobot> axes_{};
  JointValues cruise_{};  // rad/s or m/s
  JointValues acceleration_{};
  FlyType fly_type_ = FlyType::distance;
  double fly_parameter_ = 0;
  const kinematics::Chain* chain_ = nullptr;
  Pose X_BG_ = Pose::Identity();  // the TCP at the target
  double duration_ = 0;
  double t_ = 0;
};

}  // namespace cellmirror::motion
