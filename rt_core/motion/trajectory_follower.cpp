#include "rt_core/motion/trajectory_follower.hpp"

#include <algorithm>
#include <cmath>

namespace cellmirror::motion {

void TrajectoryFollower::reset(std::size_t joints) CELL_RT {
  *this = TrajectoryFollower();
  joints_ = std::min(joints, kMaxJointsPerRobot);
}

bool TrajectoryFollower::begin(const Trajectory& trajectory, std::span<const double> velocities) CELL_RT {
  if (trajectory.id <= newest_ || !is_sound(trajectory, joints_)) return false;
  // Of the trajectory that runs: its accelerations go on too.
  const bool goes_on = phase_ == Phase::following && begun_;
  for (std::size_t i = 0; i < joints_; ++i) {
    from_[i].velocity = velocities[i];
    from_[i].acceleration = goes_on ? state_.reference[i].acceleration : 0;
  }
  if (phase_ == Phase::stopping) finish(stop_outcome_);
  if (phase_ == Phase::following) finish(TrajectoryOutcome::superseded);
  trajectory_ = &trajectory;
  newest_ = trajectory.id;
  phase_ = Phase::following;
  begun_ = false;
  fastest_ = trajectory.max_velocity;
  deceleration_ = trajectory.deceleration;
  state_.running = trajectory.id;
  state_.moving = true;
  state_.given = trajectory.given;
  return true;
}

void TrajectoryFollower::finish(TrajectoryOutcome outcome) CELL_RT {
  if (state_.running == 0) return;  // it has ended, and the joints were still on their way
  state_.finished = state_.running;
  state_.running = 0;
  state_.outcome = outcome;
}

void TrajectoryFollower::rest() CELL_RT {
  phase_ = Phase::idle;
  trajectory_ = nullptr;
  state_.moving = false;
  velocities_.fill(0);
}

void TrajectoryFollower::abort(TrajectoryOutcome outcome) CELL_RT {
  if (!active()) return;
  finish(phase_ == Phase::stopping ? stop_outcome_ : outcome);
  rest();
}

void TrajectoryFollower::stop(TrajectoryOutcome outcome) CELL_RT {
  if (!active() || phase_ == Phase::stopping) return;
  if (!begun_) {
    for (std::size_t i = 0; i < joints_; ++i) velocities_[i] = from_[i].velocity;
  }
  for (std::size_t i = 0; i < joints_; ++i) fastest_[i] = std::max(fastest_[i], std::abs(velocities_[i]));
  stop_outcome_ = outcome;
  phase_ = Phase::stopping;
}

// The present state is that of the step before.
void TrajectoryFollower::start(double dt, Timestamp now, std::span<const double> q) CELL_RT {
  begun_ = true;
  start_ = trajectory_->start.known() ? trajectory_->start : now;
  from_time_ = seconds(now - start_) - dt;
  const auto& times = trajectory_->times;
  first_ = static_cast<std::size_t>(std::upper_bound(times.begin(), times.end(), from_time_) - times.begin());
  for (std::size_t i = 0; i < joints_; ++i) {
    from_[i].position = q[i];
    // A joint may be faster than the trajectory's limit where another motion ends here.
    fastest_[i] = std::max(trajectory_->max_velocity[i], std::abs(from_[i].velocity));
  }
}

void TrajectoryFollower::sample(double t) CELL_RT {
  const Trajectory& all = *trajectory_;
  const auto begin = all.times.begin() + static_cast<std::ptrdiff_t>(first_);
  const auto next = static_cast<std::size_t>(std::upper_bound(begin, all.times.end(), t) - all.times.begin());
  state_.point = static_cast<std::uint32_t>(std::min(next, all.points() - 1));
  for (std::size_t i = 0; i < joints_; ++i) {
    if (!moves(i)) continue;
    KnotState& out = state_.reference[i];
    if (next == all.points()) {
      out = {all.knot(next - 1, i).position, 0, 0};
    } else if (next == first_) {
      out = interpolate({all.orders[next], all.times[next] - from_time_}, from_[i], all.knot(next, i), t - from_time_);
    } else {
      const double before = all.times[next - 1];
      const KnotPair pair{std::min(all.orders[next - 1], all.orders[next]), all.times[next] - before};
      out = interpolate(pair, all.knot(next - 1, i), all.knot(next, i), t - before);
    }
  }
}

// True where all joints are where they are wanted.
bool TrajectoryFollower::chase(double dt, const JointRange& range, std::span<double> q, std::span<double> qd) CELL_RT {
  bool arrived = true;
  for (std::size_t i = 0; i < joints_; ++i) {
    qd[i] = 0;
    if (!moves(i)) continue;
    const KnotState& wanted = state_.reference[i];
    const double most = trajectory_->max_velocity[i] * dt;
    const double way = std::clamp(wanted.position, range.lower[i], range.upper[i]) - q[i];
    if (std::abs(way) <= most) {
      q[i] += way;
      qd[i] = std::clamp(wanted.velocity, -trajectory_->max_velocity[i], trajectory_->max_velocity[i]);
    } else {
      q[i] += std::copysign(most, way);
      qd[i] = std::copysign(trajectory_->max_velocity[i], way);
    }
    arrived = arrived && std::abs(way) <= most;
  }
  return arrived;
}

void TrajectoryFollower::check(double t, std::span<const double> q) CELL_RT {
  const bool ended = t >= trajectory_->duration();
  const bool late = trajectory_->goal_time > 0 && t > trajectory_->duration() + trajectory_->goal_time;
  bool met = true;
  for (std::size_t i = 0; i < joints_; ++i) {
    if (!moves(i)) continue;
    const double deviation = std::abs(state_.reference[i].position - q[i]);
    const double bound = ended ? trajectory_->goal_tolerance[i] : trajectory_->path_tolerance[i];
    const double slowest = trajectory_->stopped_velocity[i];
    const bool beyond = bound > 0 && deviation > bound;
    const bool moving = ended && slowest > 0 && std::abs(velocities_[i]) > slowest;
    if (!beyond && !moving) continue;
    met = false;
    if (ended && !late) continue;
    state_.joint = static_cast<std::uint8_t>(i);
    state_.deviation = deviation;
    return stop(ended ? TrajectoryOutcome::goal_tolerance : TrajectoryOutcome::path_tolerance);
  }
  if (!ended || !met) return;
  finish(TrajectoryOutcome::arrived);
  phase_ = Phase::settling;
}

bool TrajectoryFollower::brake(double dt, const JointRange& range, std::span<double> q, std::span<double> qd) CELL_RT {
  bool moving = false;
  for (std::size_t i = 0; i < joints_; ++i) {
    const double before = velocities_[i];
    const double after = std::max(std::abs(before) - deceleration_[i] * dt, 0.0);
    const double next = q[i] + std::copysign(0.5 * (std::abs(before) + after) * dt, before);
    const double within = before == 0 ? q[i] : std::clamp(next, range.lower[i], range.upper[i]);
    qd[i] = within == next ? std::copysign(after, before) : 0;
    q[i] = within;
    moving = moving || qd[i] != 0;
  }
  return moving;
}

bool TrajectoryFollower::step(double dt, Timestamp now, const JointRange& range, std::span<double> q,
                              std::span<double> qd) CELL_RT {
  if (!active()) return false;
  if (phase_ == Phase::stopping) {
    const bool moving = brake(dt, range, q, qd);
    std::ranges::copy(qd, velocities_.begin());
    if (!moving) {
      finish(stop_outcome_);
      rest();
    }
    return true;
  }
  if (!begun_) {
    start(dt, now, q);
  } else {
    fastest_ = trajectory_->max_velocity;
  }
  const double t = seconds(now - start_);
  state_.elapsed = t;
  sample(t);
  const bool arrived = chase(dt, range, q, qd);
  std::ranges::copy(qd, velocities_.begin());
  if (phase_ == Phase::following) check(t, q);
  if (phase_ == Phase::settling && arrived) rest();
  return true;
}

}  // namespace cellmirror::motion
