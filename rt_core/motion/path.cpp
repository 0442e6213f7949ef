#include "rt_core/motion/path.hpp"

#include <algorithm>
#include <limits>

namespace cellmirror::motion {

namespace {

constexpr double kNothing = 1e-12;  // m, rad

// How many times a second (a second squared) `limit` would cover `extent`.
double shares(double limit, double extent) CELL_RT {
  return extent > kNothing ? limit / extent : std::numeric_limits<double>::infinity();
}

}  // namespace

Straight Straight::between(const Move& move, const Pose& X_BS, const Pose& X_BG, double speed) CELL_RT {
  const kinematics::Twist way = kinematics::task_error(move.task, X_BS, X_BG);
  Straight out;
  out.p = way.head<3>();
  out.length = out.p.norm();
  out.angle = way.tail<3>().norm();
  if (out.angle > kNothing) {
    out.axis = way.tail<3>() / out.angle;
  } else {
    out.angle = 0;
  }
  if (out.length <= kNothing && out.angle <= kNothing) {
    out.share = Profile::to_target(1, 0, 1, {1, 1}, move.profile);
    return out;
  }
  out.cruise = std::min(shares(move.linear_velocity, out.length), shares(move.rotational_velocity, out.angle));
  const double acceleration =
      std::min(shares(move.linear_acceleration, out.length), shares(move.rotational_acceleration, out.angle));
  out.share = Profile::to_target(0, speed, 1, {out.cruise, acceleration}, move.profile);
  return out;
}

Straight Straight::to_rest(const kinematics::Twist& twist, double duration) CELL_RT {
  Straight out;
  out.p = twist.head<3>() * (0.5 * duration);
  out.length = out.p.norm();
  const double speed = twist.tail<3>().norm();
  if (speed > kNothing) out.axis = twist.tail<3>() / speed;
  out.angle = 0.5 * duration * speed;
  out.cruise = 2 / duration;
  out.share = Profile::to_target(0, out.cruise, 1, {out.cruise, out.cruise / duration}, VelocityProfile::ramp);
  return out;
}

kinematics::Twist Straight::twist() const CELL_RT {
  kinematics::Twist out;
  out << p, angle * axis;
  return out;
}

Eigen::Matrix3d Straight::rotation(double s) const CELL_RT {
  return Eigen::AngleAxisd(s * angle, axis).toRotationMatrix();
}

Pose Straight::moved(const Pose& X_BS, double s) const CELL_RT {
  Pose X = X_BS;
  X.translation() += s * p;
  if (angle > 0) X.linear() = rotation(s) * X_BS.linear();
  return X;
}

void SuperposedPath::clear(const Pose& X_BS) CELL_RT {
  X_BS_ = X_BS;
  count_ = 0;
}

void SuperposedPath::add(const Straight& straight) CELL_RT {
  if (count_ < kMost) ways_[count_++] = straight;
}

void SuperposedPath::replace(const Straight& brake) CELL_RT {
  X_BS_ = pose(0);
  ways_[0] = brake;
  count_ = 1;
}

Pose SuperposedPath::end() const CELL_RT {
  Pose X = X_BS_;
  for (std::size_t i = 0; i < count_; ++i) X = ways_[i].moved(X, 1);
  return X;
}

Pose SuperposedPath::pose(double later) const CELL_RT {
  Pose X = X_BS_;
  for (std::size_t i = 0; i < count_; ++i) X = ways_[i].moved(X, ways_[i].share.at(ways_[i].t + later).position);
  return X;
}

kinematics::Twist SuperposedPath::twist(double later) const CELL_RT {
  kinematics::Twist twist = kinematics::Twist::Zero();
  for (std::size_t i = 0; i < count_; ++i) {
    const Straight& way = ways_[i];
    const Profile::State share = way.share.at(way.t + later);
    twist.head<3>() += share.velocity * way.p;
    // The older rotations are turned by the newer ones: R = R_new(t) R_old(t) R_start.
    twist.tail<3>() = way.rotation(share.position) * twist.tail<3>() + share.velocity * way.angle * way.axis;
  }
  return twist;
}

bool SuperposedPath::ended(double later) const CELL_RT {
  for (std::size_t i = 0; i < count_; ++i) {
    if (!ways_[i].ended(later)) return false;
  }
  return true;
}

bool SuperposedPath::advance(double dt) CELL_RT {
  for (std::size_t i = 0; i < count_; ++i) ways_[i].t += dt;
  if (count_ < 2 || !ways_[0].ended()) return false;
  X_BS_ = ways_[0].moved(X_BS_, 1);
  ways_[0] = ways_[1];
  count_ = 1;
  return true;
}

}  // namespace cellmirror::motion
