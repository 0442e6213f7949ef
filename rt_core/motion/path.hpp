// A path of the TCP, straight or an arc, and the pose of several superposed ones. Belongs to the tick thread.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>

#include "rt_core/base/pose.hpp"
#include "rt_core/base/real_time.hpp"
#include "rt_core/kinematics/forward.hpp"
#include "rt_core/kinematics/task.hpp"
#include "rt_core/motion/arc.hpp"
#include "rt_core/motion/move.hpp"
#include "rt_core/motion/pace.hpp"
#include "rt_core/motion/profile.hpp"

namespace cellmirror::motion {

// A displacement whose share s grows from 0 to 1 by a profile: translation by s * p, or along an arc by s * arc.angle,
// and rotation about one axis by s * angle; all expressed in the base.
struct Way {
  Eigen::Vector3d p = Eigen::Vector3d::Zero();  // m; of the whole translation
  Arc arc;                                      // of an angle of 0: straight
  Eigen::Vector3d axis = Eigen::Vector3d::UnitZ();
  double length = 0;        // of the way of the TCP, m
  double angle = 0;         // rad, not negative
  double cruise = 0;        // 1/s; what the move's velocities make of the share
  double acceleration = 0;  // 1/s2
  Profile share;
  double t = 0;  // s

  // From X_BS to X_BG as far as the task counts; the slower of translation and rotation decides, for the velocity and
  // for the acceleration. Manual, rob_cart_lin_vel and the following. On an arc the velocity is such that the
  // centripetal acceleration does not exceed the linear one. `speed`: of the share at the beginning, 1/s.
  [[nodiscard]] static Way between(const Move& move, const Pose& X_BS, const Pose& X_BG, double speed = 0) CELL_RT;
  // The straight way on which something that moves with `twist` comes to rest with constant deceleration within
  // `duration` s.
  [[nodiscard]] static Way to_rest(const kinematics::Twist& twist, double duration) CELL_RT;

  // From rest, in a time shorter by `lag` s, or as much of it as accelerations up to kHardestCatchUp times its own make
  // possible. Gives what it gained, s. Only before it begins.
  double catch_up(double lag, VelocityProfile shape) CELL_RT;

  // Of the tool at the share s, for a share that grows by 1 a second.
  [[nodiscard]] kinematics::Twist twist(double s = 0) const CELL_RT;
  [[nodiscard]] bool ended(double later = 0) const CELL_RT { return t + later >= share.duration(); }
  [[nodiscard]] Eigen::Matrix3d rotation(double s) const CELL_RT;
  // X_BS moved by the share s of the displacement.
  [[nodiscard]] Pose moved(const Pose& X_BS, double s) const CELL_RT;
};

// Two displacements at most, one superposed on the other: translations add, rotations compose.
class SuperposedPath {
 public:
  static constexpr std::size_t kMost = 2;

  void clear(const Pose& X_BS) CELL_RT;
  // Refused (by contract): a third one.
  void add(const Way& way) CELL_RT;
  // All that is left becomes one way to rest, from the present pose and the velocity `twist`.
  void replace(const Way& brake) CELL_RT;
  // To rest on the one way that there is, at its acceleration, from a speed of `pace` times that of its profile.
  void brake(double pace) CELL_RT;

  [[nodiscard]] std::size_t count() const CELL_RT { return count_; }
  [[nodiscard]] const Way& newest() const CELL_RT { return ways_[count_ - 1]; }
  // Where it all ends.
  [[nodiscard]] Pose end() const CELL_RT;
  // The target `later` seconds from now, and its velocity.
  [[nodiscard]] Pose pose(double later) const CELL_RT;
  [[nodiscard]] kinematics::Twist twist(double later) const CELL_RT;
  [[nodiscard]] bool ended(double later) const CELL_RT;
  // How long ago it ended, where it has; s of the path.
  [[nodiscard]] double overrun() const CELL_RT;
  // How the pace of its time may change while it has the value `pace`: no way is accelerated more than it may be.
  [[nodiscard]] PaceChange pace_change(double pace) const CELL_RT;
  // Advances time. True if the older one of two has ended and was dropped.
  bool advance(double dt) CELL_RT;

  // Its members, for a recording of the tick (rt_core/base/state_bytes.hpp).
  template <class Archive>
  void transfer(Archive& archive) CELL_RT {
    archive(X_BS_);
    archive.bounded(count_, kMost);
    archive.first(ways_, count_);
  }

 private:
  Pose X_BS_ = Pose::Identity();  // where the oldest begins
  std::array<Way, kMost> ways_{};
  std::size_t count_ = 0;
};

}  // namespace cellmirror::motion
