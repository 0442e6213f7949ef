#include "rt_core/motion/executor.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "rt_core/motion/pace.hpp"

namespace cellmirror::motion {

namespace {

bool within(const Move& move, const JointRange& range, std::size_t joints) CELL_RT {
  constexpr double kSlack = 1e-9;  // as the limiter's
  for (std::size_t i = 0; i < joints; ++i) {
    if (move.target[i] < range.lower[i] - kSlack || move.target[i] > range.upper[i] + kSlack) return false;
  }
  return true;
}

bool of_tcp(const Move& move) CELL_RT { return move.kind == MoveKind::linear || move.kind == MoveKind::circular; }

Nanoseconds nanoseconds(double seconds) CELL_RT { return Nanoseconds(static_cast<std::int64_t>(seconds * 1e9)); }

}  // namespace

void MoveExecutor::reset(std::size_t joints) CELL_RT {
  joints_ = std::min(joints, kMaxJointsPerRobot);
  chain_ = nullptr;
  state_ = {};
  newest_ = 0;
  end_holds();
  come_to_rest();
}

bool MoveExecutor::uses(const kinematics::Chain& chain) const CELL_RT {
  if (chain_ == &chain) return true;
  if (activity_ == Activity::path && linear_.chain() == &chain) return true;
  if (activity_ == Activity::joints && ptp_.chain() == &chain) return true;
  for (std::size_t i = 0; i < state_.waiting; ++i) {
    if (queue_[(first_ + i) % kMoveQueue].chain == &chain) return true;
  }
  return false;
}

void MoveExecutor::set_pace(double pace) CELL_RT {
  if (std::isfinite(pace)) wanted_pace_ = std::clamp(pace, 0.0, 1.0);
}

void MoveExecutor::end_holds() CELL_RT {
  pace_ = wanted_pace_ = 1;
  gate_ = 0;
  state_.pace = 1;
}

void MoveExecutor::come_to_rest() CELL_RT {
  activity_ = Activity::standing;
  blend_ = brake_ = braking_ = false;
  halt_through_ = 0;
  late_ = 0;
  lag_ = kNoLag;
  qd_.fill(0);
  state_.running = 0;
}

// Every id up to `id` that is open ends now.
void MoveExecutor::end_through(std::uint32_t id, Outcome outcome, double overrun) CELL_RT {
  if (id <= state_.finished) return;
  state_.finished_time = now_ - nanoseconds(overrun);
  state_.finished_from = state_.finished + 1;
  state_.finished = id;
  state_.outcome = outcome;
}

bool MoveExecutor::push(const Move& move) CELL_RT {
  if (state_.waiting == kMoveQueue) return false;
  queue_[(first_ + state_.waiting) % kMoveQueue] = {move, chain_};
  ++state_.waiting;
  return true;
}

void MoveExecutor::pop() CELL_RT {
  first_ = (first_ + 1) % kMoveQueue;
  --state_.waiting;
}

bool MoveExecutor::blends(const Move& move) const CELL_RT {
  if (activity_ == Activity::joints) return move.kind == MoveKind::joints;
  return activity_ == Activity::path && move.kind == MoveKind::linear && linear_.fits(move, chain_);
}

void MoveExecutor::supersede(const Move& move) CELL_RT {
  if (halt_through_ != 0) end_through(halt_through_, halt_outcome_);
  halt_through_ = 0;
  end_through(move.id - 1, Outcome::superseded);
  state_.waiting = 0;
  push(move);
  blend_ = blends(move);
  brake_ = !blend_ && activity_ != Activity::standing;
  wanted_pace_ = 1;
  gate_ = 0;
  state_.running = move.id;
}

bool MoveExecutor::add(const Move& move) CELL_RT {
  if (move.id <= newest_) return false;
  newest_ = move.id;
  const bool taken = is_sound(move, joints_) && (!of_tcp(move) || chain_ != nullptr) &&
                     (move.start == Start::supersede || state_.waiting < kMoveQueue);
  if (taken && move.start == Start::supersede) supersede(move);
  if (taken && move.start == Start::queue) push(move);
  state_.moving = true;  // until the next step has checked
  return taken;
}

void MoveExecutor::halt(Outcome outcome) CELL_RT {
  state_.waiting = 0;
  blend_ = false;
  wanted_pace_ = 1;
  gate_ = 0;
  if (activity_ == Activity::standing) {
    end_through(newest_, outcome);
    return;
  }
  brake_ = true;
  halt_through_ = newest_;
  halt_outcome_ = outcome;
}

void MoveExecutor::abort(Outcome outcome) CELL_RT {
  state_.waiting = 0;
  end_through(newest_, outcome);
  end_holds();
  come_to_rest();
  state_.moving = false;
}

bool MoveExecutor::start_path(std::span<const double> q) CELL_RT {
  const Queued& next = front();
  if (activity_ == Activity::path) {
    linear_.blend(next.move, std::exchange(pace_, 1.0));
    return true;
  }
  if (next.chain == nullptr || next.chain->variable_count() != joints_) return false;
  const double lag = lag_of(next.move);
  late_ = lag - linear_.start(next.move, *next.chain, q, lag);
  activity_ = Activity::path;
  return true;
}

// Out of a motion under way as well: then in the time of its path, which goes at pace_.
bool MoveExecutor::start_joints(const JointRange& range, std::span<const double> q) CELL_RT {
  const Move& move = front().move;
  if (!within(move, range, joints_)) return false;  // the range was narrowed meanwhile
  const bool from_rest = activity_ == Activity::standing;
  JointValues qd{};
  for (std::size_t i = 0; i < joints_; ++i) {
    fastest_[i] = std::max(move.max_velocity[i], std::abs(qd_[i]));
    if (!from_rest && pace_ > 0) qd[i] = qd_[i] / pace_;
  }
  ptp_.start(move, q, std::span(qd).first(joints_), range);
  ptp_.set_fly_point(move, front().chain);
  const double lag = lag_of(move);
  late_ = from_rest ? lag - ptp_.catch_up(move, lag, q, range) : 0;
  activity_ = Activity::joints;
  return true;
}

// By how much a move that begins out of rest in this step begins late.
double MoveExecutor::lag_of(const Move& move) const CELL_RT {
  if (activity_ != Activity::standing) return 0;
  double lag = lag_;
  if (lag == kNoLag && move.begin.known()) lag = seconds(now_ - move.begin) - dt_;
  if (lag == kNoLag && move.follows_on && state_.outcome == Outcome::arrived) {
    const double idle = seconds(now_ - state_.finished_time) - dt_;
    if (idle <= kMostCatchUp) lag = idle;
  }
  return std::clamp(lag, 0.0, kMostCatchUp);
}

void MoveExecutor::start_front(const JointRange& range, std::span<const double> q) CELL_RT {
  const Move& move = front().move;
  state_.running = move.id;
  // Ended earlier and not reported yet: moves refused by the queue.
  end_through(move.id - 1, Outcome::blocked);
  bool started = true;
  switch (move.kind) {
    case MoveKind::joints:
      started = start_joints(range, q);
      break;
    case MoveKind::linear:
    case MoveKind::circular:
      started = start_path(q);
      break;
    case MoveKind::delay: {
      const double lag = lag_of(move);
      late_ = std::max(lag - move.delay_s, 0.0);
      delay_left_ = move.delay_s - (lag - late_);
      activity_ = Activity::delay;
      break;
    }
  }
  blend_ = brake_ = braking_ = false;
  lag_ = kNoLag;
  if (started) {
    pop();
  } else {
    halt(Outcome::blocked);
  }
}

bool MoveExecutor::flies(const JointRange& range, std::span<const double> q) const CELL_RT {
  if (braking_ || brake_ || pace_ <= 0 || state_.waiting == 0) return false;
  const Queued& next = front();
  if (next.move.start != Start::queue || !may_begin(next.move)) return false;
  if (activity_ == Activity::path) return linear_.fits(next.move, next.chain) && linear_.at_fly_point();
  return activity_ == Activity::joints && next.move.kind == MoveKind::joints && within(next.move, range, joints_) &&
         ptp_.at_fly_point(q);
}

void MoveExecutor::fly(const JointRange& range, std::span<const double> q) CELL_RT {
  late_ = 0;
  if (activity_ == Activity::joints) {
    end_through(state_.running, Outcome::arrived);
    start_front(range, q);
    return;
  }
  linear_.append(front().move);
  state_.running = front().move.id;
  pop();
}

void MoveExecutor::brake(const JointRange& range, std::span<const double> q) CELL_RT {
  brake_ = false;
  braking_ = true;
  const double pace = std::exchange(pace_, 1.0);  // the braking knows the real velocities
  if (activity_ == Activity::joints) ptp_.brake(q, std::span(qd_).first(joints_), range);
  if (activity_ == Activity::path) {
    // What took its place was added for another chain, and its owner may take this one away now that its moves have
    // ended: no braking on the line.
    const bool chain_may_go = halt_through_ == 0 && linear_.chain() != chain_;
    chain_may_go ? brake_off_line(range, q) : linear_.brake(pace);
  }
  if (activity_ == Activity::delay) delay_left_ = 0;
}

void MoveExecutor::brake_off_line(const JointRange& range, std::span<const double> q) CELL_RT {
  const std::span<const double> qd = std::span(qd_).first(joints_);
  for (std::size_t i = 0; i < joints_; ++i) fastest_[i] = std::max(linear_.max_velocity()[i], std::abs(qd[i]));
  ptp_.brake_together(linear_.acceleration(), q, qd, range);
  activity_ = Activity::joints;
}

bool MoveExecutor::advance_path(double dt, const JointRange& range, std::span<double> q) CELL_RT {
  const std::span<double> qd = std::span(qd_).first(joints_);
  const LinearMotion::Progress progress = linear_.advance(dt, pace_, q, qd);
  fastest_ = linear_.max_velocity();
  if (linear_.older_ended() && !braking_) end_through(state_.running - 1, Outcome::arrived);
  if (progress != LinearMotion::Progress::blocked) return progress == LinearMotion::Progress::arrived;
  // There is no path to brake on: the joints come to rest in the direction in which they move.
  if (!braking_) halt(Outcome::blocked);
  brake_ = false;
  braking_ = true;
  pace_ = 1;
  brake_off_line(range, q);
  return ptp_.advance(dt, q, qd);
}

// True when the activity has ended.
bool MoveExecutor::advance(double dt, const JointRange& range, std::span<double> q) CELL_RT {
  switch (activity_) {
    case Activity::joints: {
      const bool arrived = ptp_.advance(pace_ * dt, q, std::span(qd_).first(joints_));
      for (std::size_t i = 0; i < joints_; ++i) qd_[i] *= pace_;
      return arrived;
    }
    case Activity::path:
      return advance_path(dt, range, q);
    case Activity::delay:
      delay_left_ -= pace_ * dt;
      return delay_left_ <= 0;
    case Activity::standing:
      break;
  }
  return true;
}

// How long before the end of this step the activity ended, s.
double MoveExecutor::overrun() const CELL_RT {
  double seconds = 0;
  if (activity_ == Activity::joints) seconds = ptp_.overrun() / pace_;
  if (activity_ == Activity::path) seconds = linear_.overrun();
  if (activity_ == Activity::delay) seconds = -delay_left_ / pace_;
  return std::clamp(seconds, 0.0, dt_);
}

void MoveExecutor::arrive() CELL_RT {
  const std::uint32_t running = state_.running;
  const std::uint32_t halted = halt_through_;
  const bool braked = braking_;
  const double over = braked ? 0 : overrun() + late_;
  come_to_rest();
  if (halted != 0) end_through(halted, halt_outcome_);
  if (!braked) end_through(running, Outcome::arrived, over);
  if (state_.waiting == 0) return;
  state_.running = front().move.id;
  lag_ = over;
}

// The requested pace, as far as the accelerations allow. Braking to rest uses its own time.
void MoveExecutor::go_on_with_pace(double dt) CELL_RT {
  if (braking_ || brake_ || !(dt > 0)) return;
  PaceChange change;
  if (activity_ == Activity::joints) change = ptp_.pace_change(pace_, joints_);
  if (activity_ == Activity::path) change = linear_.pace_change(pace_);
  pace_ = std::clamp(wanted_pace_, pace_ + change.least * dt, pace_ + change.most * dt);
}

// Nothing runs in this step.
void MoveExecutor::rest() CELL_RT {
  lag_ = kNoLag;
  state_.moving = state_.waiting > 0;
  if (state_.moving) {  // held: when it begins is not its own affair any more
    queue_[first_].move.begin = Timestamp();
    return;
  }
  end_through(newest_, Outcome::blocked);  // refused, and nothing behind it
  state_.running = 0;
}

bool MoveExecutor::step(double dt, Timestamp now, const JointRange& range, std::span<double> q,
                        std::span<double> qd) CELL_RT {
  now_ = now;
  dt_ = dt;
  go_on_with_pace(dt);
  state_.pace = pace_;
  const bool next =
      state_.waiting > 0 && (activity_ == Activity::standing ? pace_ > 0 && may_begin(front().move) : blend_);
  if (next) start_front(range, q);
  if (activity_ == Activity::standing) {
    rest();
    return false;
  }
  if (brake_) brake(range, q);
  if (flies(range, q)) fly(range, q);
  if (pace_ > 0) {
    if (advance(dt, range, q)) arrive();
  } else {
    qd_.fill(0);  // held
  }
  std::ranges::copy(std::span(qd_).first(joints_), qd.begin());
  // Until every id has ended: the next step reports those refused by the queue.
  state_.moving = activity_ != Activity::standing || state_.waiting > 0 || state_.finished < newest_;
  return true;
}

}  // namespace cellmirror::motion
