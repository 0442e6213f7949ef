#include "rt_core/motion/path.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace cellmirror::motion {

namespace {

constexpr double kNothing = 1e-12;  // m, rad

// How many times a second (a second squared) `limit` would cover `extent`.
double shares(double limit, double extent) CELL_RT {
  return extent > kNothing ? limit / extent : std::numeric_limits<double>::infinity();
}

}  // namespace

Way Way::between(const Move& move, const Pose& X_BS, const Pose& X_BG, double speed) CELL_RT {
  const kinematics::Twist way = kinematics::task_error(move.task, X_BS, X_BG);
  Way out;
  out.p = way.head<3>();
  out.length = out.p.norm();
  out.angle = way.tail<3>().norm();
  if (out.angle > kNothing) {
    out.axis = way.tail<3>() / out.angle;
  } else {
    out.angle = 0;
  }
  double linear_velocity = move.linear_velocity;
  if (move.kind == MoveKind::circular) {
    // The planner has refused what is no circle; were it one no more, the TCP would go straight.
    out.arc = Arc::through(X_BS.translation(), move.p_BV, X_BG.translation()).value_or(Arc());
    if (out.arc.angle > 0) {
      out.length = out.arc.radius() * out.arc.angle;
      linear_velocity = std::min(linear_velocity, std::sqrt(move.linear_acceleration * out.arc.radius()));
    }
  }
  if (out.length <= kNothing && out.angle <= kNothing) {
    out.share = Profile::to_target(1, 0, 1, {1, 1}, move.profile);
    return out;
  }
  out.cruise = std::min(shares(linear_velocity, out.length), shares(move.rotational_velocity, out.angle));
  out.acceleration =
      std::min(shares(move.linear_acceleration, out.length), shares(move.rotational_acceleration, out.angle));
  out.share = Profile::to_target(0, speed, 1, {out.cruise, out.acceleration}, move.profile);
  return out;
}

Way Way::to_rest(const kinematics::Twist& twist, double duration) CELL_RT {
  Way out;
  out.p = twist.head<3>() * (0.5 * duration);
  out.length = out.p.norm();
  const double speed = twist.tail<3>().norm();
  if (speed > kNothing) out.axis = twist.tail<3>() / speed;
  out.angle = 0.5 * duration * speed;
  out.cruise = 2 / duration;
  out.acceleration = out.cruise / duration;
  out.share = Profile::to_target(0, out.cruise, 1, {out.cruise, out.acceleration}, VelocityProfile::ramp);
  return out;
}

double Way::catch_up(double lag, VelocityProfile shape) CELL_RT {
  const double duration = share.duration();
  if (!(lag > 0) || !(duration > 0)) return 0;
  const double wanted = Profile::acceleration_for(duration - lag, 1, cruise);
  acceleration = std::clamp(wanted, acceleration, kHardestCatchUp * acceleration);
  share = Profile::to_target(0, 0, 1, {cruise, acceleration}, shape);
  return duration - share.duration();
}

kinematics::Twist Way::twist(double s) const CELL_RT {
  kinematics::Twist out;
  out << (arc.angle > 0 ? arc.velocity(s) : p), angle * axis;
  return out;
}

Eigen::Matrix3d Way::rotation(double s) const CELL_RT { return Eigen::AngleAxisd(s * angle, axis).toRotationMatrix(); }

Pose Way::moved(const Pose& X_BS, double s) const CELL_RT {
  Pose X = X_BS;
  X.translation() += arc.angle > 0 && s < 1 ? arc.displacement(s) : Eigen::Vector3d(s * p);
  if (angle > 0) X.linear() = rotation(s) * X_BS.linear();
  return X;
}

void SuperposedPath::clear(const Pose& X_BS) CELL_RT {
  X_BS_ = X_BS;
  count_ = 0;
}

void SuperposedPath::add(const Way& way) CELL_RT {
  if (count_ < kMost) ways_[count_++] = way;
}

void SuperposedPath::replace(const Way& brake) CELL_RT {
  X_BS_ = pose(0);
  ways_[0] = brake;
  count_ = 1;
}

void SuperposedPath::brake(double pace) CELL_RT {
  Way& way = ways_[0];
  const Profile::State share = way.share.at(way.t);
  // A sine brakes late: in the middle of its braking it takes more than its acceleration to stop before the end.
  const AxisLimits limits{.velocity = way.cruise, .acceleration = way.acceleration, .lower = 0, .upper = 1};
  way.share = Profile::to_rest(share.position, pace * share.velocity, limits);
  way.t = 0;
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
    const Way& way = ways_[i];
    const Profile::State share = way.share.at(way.t + later);
    const kinematics::Twist own = share.velocity * way.twist(share.position);
    twist.head<3>() += own.head<3>();
    // The older rotations are turned by the newer ones: R = R_new(t) R_old(t) R_start.
    twist.tail<3>() = way.rotation(share.position) * twist.tail<3>() + own.tail<3>();
  }
  return twist;
}

bool SuperposedPath::ended(double later) const CELL_RT {
  for (std::size_t i = 0; i < count_; ++i) {
    if (!ways_[i].ended(later)) return false;
  }
  return true;
}

double SuperposedPath::overrun() const CELL_RT {
  double shortest = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < count_; ++i) shortest = std::min(shortest, ways_[i].t - ways_[i].share.duration());
  return count_ > 0 ? std::max(shortest, 0.0) : 0.0;
}

PaceChange SuperposedPath::pace_change(double pace) const CELL_RT {
  PaceChange change;
  for (std::size_t i = 0; i < count_; ++i) {
    const Profile::State share = ways_[i].share.at(ways_[i].t);
    change.bound(share.velocity, share.acceleration, ways_[i].acceleration, pace);
  }
  return change;
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
