#include "rt_core/motion/linear.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "rt_core/kinematics/fast_step.hpp"

namespace cellmirror::motion {

namespace {

constexpr double kEndTolerance = 1e-11;  // of the last step: requested
constexpr int kIterations = 6;           // of one search; a smooth path takes 2
constexpr int kTries = 5;                // searches in a tick at most
constexpr int kTriesWithoutPosture = 2;
constexpr double kShorterTry = 0.25;
constexpr double kSlowestPace = 1e-4;     // below: blocked
constexpr double kRecovery = 0.25;        // s from standing time to full pace
constexpr double kBelowLimit = 1 - 1e-7;  // so that rounding does not lift a joint above its limit
constexpr double kShortest = 1e-9;        // s; of braking
constexpr double kNoWay = 1e-20;          // s2
constexpr int kBlendRounds = 10;
constexpr double kShrink = 0.98;  // a shorter step is not quite in proportion

// By what a step has to be shortened so that no joint is too fast; 1 and more: it need not be.
double share_allowed(std::span<const double> from, std::span<const double> to, std::span<const double> velocity,
                     double dt) CELL_RT {
  double share = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < from.size(); ++i) {
    const double step = std::abs(to[i] - from[i]);
    if (step > 0) share = std::min(share, velocity[i] * dt * kBelowLimit / step);
  }
  return share;
}

// How much of the velocity `twist` leads along `way`, in 1/s: the projection, where velocities count in shares of what
// the move allows.
double speed_along(const Way& way, const kinematics::Twist& twist, const Move& move) CELL_RT {
  const kinematics::Twist along = way.twist();
  const double linear = 1 / (move.linear_velocity * move.linear_velocity);
  const double rotational = 1 / (move.rotational_velocity * move.rotational_velocity);
  const double square = linear * along.head<3>().squaredNorm() + rotational * along.tail<3>().squaredNorm();
  const double product =
      linear * along.head<3>().dot(twist.head<3>()) + rotational * along.tail<3>().dot(twist.tail<3>());
  return square > kNoWay ? std::max(product / square, 0.0) : 0.0;
}

bool same_task(const kinematics::Task& a, const kinematics::Task& b) CELL_RT {
  return a.position_axes == b.position_axes && a.orientation == b.orientation &&
         a.orientation_required == b.orientation_required && a.secondary == b.secondary;
}

}  // namespace

void LinearMotion::take_limits(const Move& move, bool superposed) CELL_RT {
  for (std::size_t i = 0; i < chain_->variable_count(); ++i) {
    max_velocity_[i] = superposed ? std::max(max_velocity_[i], move.max_velocity[i]) : move.max_velocity[i];
  }
  linear_velocity_ = superposed ? std::max(linear_velocity_, move.linear_velocity) : move.linear_velocity;
  rotational_velocity_ =
      superposed ? std::max(rotational_velocity_, move.rotational_velocity) : move.rotational_velocity;
}

double LinearMotion::start(const Move& move, const kinematics::Chain& chain, std::span<const double> q,
                           double lag) CELL_RT {
  chain_ = &chain;
  move_ = move;
  std::ranges::copy(q, posture_.begin());
  const Pose X_BS = kinematics::forward(chain, q);
  Way way = Way::between(move, X_BS, move.X_BG);
  const double gained = way.catch_up(lag, move.profile);
  path_.clear(X_BS);
  path_.add(way);
  take_limits(move, false);
  pace_ = 1;
  older_ended_ = false;
  return gained;
}

void LinearMotion::append(const Move& move) CELL_RT {
  take_limits(move, true);
  move_ = move;
  path_.add(Way::between(move, path_.end(), move.X_BG));
}

double LinearMotion::stopping_time(const kinematics::Twist& twist) const CELL_RT {
  return std::max(twist.head<3>().norm() / move_.linear_acceleration,
                  twist.tail<3>().norm() / move_.rotational_acceleration);
}

void LinearMotion::brake(double pace) CELL_RT {
  // At its real velocity; from here time advances at full pace.
  pace *= std::exchange(pace_, 1.0);
  if (path_.count() == 1) {
    path_.brake(pace);
    return;
  }
  const kinematics::Twist twist = pace * path_.twist(0);
  const double duration = stopping_time(twist);
  if (duration > kShortest) {
    path_.replace(Way::to_rest(twist, duration));
  } else {
    path_.clear(path_.pose(0));
  }
}

void LinearMotion::blend(const Move& move, double pace) CELL_RT {
  const kinematics::Twist twist = pace * std::exchange(pace_, 1.0) * path_.twist(0);
  const Pose X_BN = path_.pose(0);
  Way way = Way::between(move, X_BN, move.X_BG);
  double speed = speed_along(way, twist, move);
  way = Way::between(move, X_BN, move.X_BG, speed);
  Way rest;
  double duration = 0;
  // The way begins where the rest of the velocity stops, and what that rest is depends on the direction of the way: a
  // contraction by a half at least, since `speed` is bounded.
  for (int i = 0; i < kBlendRounds; ++i) {
    const kinematics::Twist left = twist - speed * way.twist();
    duration = stopping_time(left);
    if (duration <= kShortest) break;
    speed = std::min(speed, 1 / duration);
    rest = Way::to_rest(left, duration);
    way = Way::between(move, rest.moved(X_BN, 1), move.X_BG, speed);
  }
  take_limits(move, true);
  move_ = move;
  path_.clear(X_BN);
  if (duration > kShortest) path_.add(rest);
  path_.add(way);
}

bool LinearMotion::fits(const Move& move, const kinematics::Chain* chain) const CELL_RT {
  const bool of_tcp = move.kind == MoveKind::linear || move.kind == MoveKind::circular;
  return of_tcp && chain == chain_ && same_task(move.task, move_.task);
}

bool LinearMotion::at_fly_point() const CELL_RT {
  if (path_.count() != 1 || move_.fly_parameter <= 0) return false;
  const Way& way = path_.newest();
  const Profile::State share = way.share.at(way.t);
  const double left = 1 - share.position;
  switch (move_.fly_type) {
    case FlyType::speed_fraction:
      return share.braking_to_target && share.velocity < move_.fly_parameter * way.cruise;
    case FlyType::distance:  // a way without translation (rotation) has no such point
      return way.length > 0 && left * way.length < move_.fly_parameter;
    case FlyType::angle:
      return way.angle > 0 && left * way.angle < move_.fly_parameter;
  }
  return false;
}

// Two moves in one direction would add up to more than either may have.
double LinearMotion::pace_of_tool(double dt, double pace) const CELL_RT {
  if (path_.count() < 2) return 1;
  const kinematics::Twist now = pace * path_.twist(0);
  const kinematics::Twist then = pace * path_.twist(pace * dt);
  const double linear = std::max(now.head<3>().norm(), then.head<3>().norm());
  const double rotational = std::max(now.tail<3>().norm(), then.tail<3>().norm());
  double slowed = 1;
  if (linear > linear_velocity_) slowed = linear_velocity_ / linear;
  if (rotational > rotational_velocity_) slowed = std::min(slowed, rotational_velocity_ / rotational);
  return slowed;
}

bool LinearMotion::find_posture(double later, JointValues& posture) const CELL_RT {
  posture = posture_;
  const std::span<double> q = std::span(posture).first(chain_->variable_count());
  const bool last = path_.ended(later);
  const kinematics::FastResult found = kinematics::fast_solve(
      *chain_, move_.task, path_.pose(later), q,
      {.tolerance = last ? kEndTolerance : kPathTolerance, .max_iterations = last ? 2 * kIterations : kIterations});
  return found.solved || kinematics::meets(move_.task, found.error, kPathTaken);
}

// A joint that would move slower than its minimum waits until it can make a whole step at that velocity, as a stepping
// motor does; the last step is what is left.
void LinearMotion::put(const JointValues& posture, bool last, double dt, std::span<double> q,
                       std::span<double> qd) const CELL_RT {
  for (std::size_t i = 0; i < q.size(); ++i) {
    const double step = posture[i] - q[i];
    const double least = std::min(move_.min_velocity[i], max_velocity_[i] * kBelowLimit) * dt;
    const bool waits = !last && std::abs(step) < least;
    qd[i] = waits || !(dt > 0) ? 0 : step / dt;
    if (!waits) q[i] = posture[i];
  }
}

LinearMotion::Progress LinearMotion::advance(double dt, double asked_pace, std::span<double> q,
                                             std::span<double> qd) CELL_RT {
  older_ended_ = false;
  if (!(dt > 0)) return Progress::under_way;
  double pace = std::min({pace_ + dt / kRecovery, 1.0, pace_of_tool(dt, asked_pace)});
  JointValues posture;
  int without_posture = 0;
  for (int i = 0; i < kTries && pace >= kSlowestPace; ++i) {
    const double step = pace * asked_pace * dt;
    if (!find_posture(step, posture)) {
      if (++without_posture == kTriesWithoutPosture) return Progress::blocked;
      pace *= kShorterTry;
      continue;
    }
    const double share = share_allowed(q, std::span(posture).first(q.size()), max_velocity_, dt);
    if (share < 1) {
      pace *= kShrink * share;
      continue;
    }
    const bool last = path_.ended(step);
    put(posture, last, dt, q, qd);
    posture_ = posture;
    pace_ = pace;
    older_ended_ = path_.advance(step);
    overrun_ = last ? path_.overrun() / (pace * asked_pace) : 0;
    if (older_ended_) take_limits(move_, false);
    return last ? Progress::arrived : Progress::under_way;
  }
  return Progress::blocked;
}

}  // namespace cellmirror::motion
