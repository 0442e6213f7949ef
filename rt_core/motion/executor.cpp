#include "rt_core/motion/executor.hpp"

#include <algorithm>
#include <cmath>

namespace cellmirror::motion {

namespace {

bool within(const Move& move, const JointRange& range, std::size_t joints) CELL_RT {
  constexpr double kSlack = 1e-9;  // as the limiter's
  for (std::size_t i = 0; i < joints; ++i) {
    if (move.target[i] < range.lower[i] - kSlack || move.target[i] > range.upper[i] + kSlack) return false;
  }
  return true;
}

}  // namespace

void MoveExecutor::reset(std::size_t joints) CELL_RT {
  joints_ = std::min(joints, kMaxJointsPerRobot);
  chain_ = nullptr;
  state_ = {};
  newest_ = 0;
  come_to_rest();
}

void MoveExecutor::come_to_rest() CELL_RT {
  activity_ = Activity::standing;
  blend_ = brake_ = braking_ = false;
  halt_through_ = 0;
  qd_.fill(0);
  state_.running = 0;
}

// Every id up to `id` that is open ends now.
void MoveExecutor::end_through(std::uint32_t id, Outcome outcome) CELL_RT {
  if (id <= state_.finished) return;
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
  return activity_ == Activity::linear && linear_.fits(move, chain_);
}

void MoveExecutor::supersede(const Move& move) CELL_RT {
  if (halt_through_ != 0) end_through(halt_through_, halt_outcome_);
  halt_through_ = 0;
  end_through(move.id - 1, Outcome::superseded);
  state_.waiting = 0;
  push(move);
  blend_ = blends(move);
  brake_ = !blend_ && activity_ != Activity::standing;
  state_.running = move.id;
}

bool MoveExecutor::add(const Move& move) CELL_RT {
  if (move.id <= newest_) return false;
  newest_ = move.id;
  const bool taken = is_sound(move, joints_) && (move.kind != MoveKind::linear || chain_ != nullptr) &&
                     (move.start == Start::supersede || state_.waiting < kMoveQueue);
  if (taken && move.start == Start::supersede) supersede(move);
  if (taken && move.start == Start::queue) push(move);
  state_.moving = true;  // until the next step has looked
  return taken;
}

void MoveExecutor::halt(Outcome outcome) CELL_RT {
  state_.waiting = 0;
  blend_ = false;
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
  come_to_rest();
  state_.moving = false;
}

bool MoveExecutor::start_linear(std::span<const double> q) CELL_RT {
  const Queued& next = front();
  if (activity_ == Activity::linear) {
    linear_.blend(next.move);
    return true;
  }
  if (next.chain == nullptr || next.chain->variable_count() != joints_) return false;
  linear_.start(next.move, *next.chain, q);
  activity_ = Activity::linear;
  return true;
}

void MoveExecutor::start_front(const JointRange& range, std::span<const double> q) CELL_RT {
  const Move& move = front().move;
  const std::span<const double> qd = std::span(qd_).first(joints_);
  blend_ = brake_ = braking_ = false;
  state_.running = move.id;
  // What ended before it and was not told yet: moves that the queue refused.
  end_through(move.id - 1, Outcome::blocked);
  bool started = true;
  switch (move.kind) {
    case MoveKind::joints:
      started = within(move, range, joints_);  // not where the range was narrowed meanwhile
      if (!started) break;
      for (std::size_t i = 0; i < joints_; ++i) fastest_[i] = std::max(move.max_velocity[i], std::abs(qd[i]));
      ptp_.start(move, q, qd, range);
      activity_ = Activity::joints;
      break;
    case MoveKind::linear:
      started = start_linear(q);
      break;
    case MoveKind::delay:
      delay_left_ = move.delay_s;
      activity_ = Activity::delay;
      break;
  }
  if (started) {
    pop();
  } else {
    halt(Outcome::blocked);
  }
}

bool MoveExecutor::flies() const CELL_RT {
  return activity_ == Activity::linear && !braking_ && !brake_ && state_.waiting > 0 &&
         front().move.start == Start::queue && linear_.fits(front().move, front().chain) && linear_.at_fly_point();
}

void MoveExecutor::fly() CELL_RT {
  linear_.append(front().move);
  state_.running = front().move.id;
  pop();
}

void MoveExecutor::brake(const JointRange& range, std::span<const double> q) CELL_RT {
  brake_ = false;
  braking_ = true;
  if (activity_ == Activity::joints) ptp_.brake(q, std::span(qd_).first(joints_), range);
  if (activity_ == Activity::linear) {
    // What took its place was added for another chain, and its owner may take this one away now that its moves have
    // ended: no braking on the line.
    const bool chain_may_go = halt_through_ == 0 && linear_.chain() != chain_;
    chain_may_go ? brake_off_line(range, q) : linear_.brake();
  }
  if (activity_ == Activity::delay) delay_left_ = 0;
}

void MoveExecutor::brake_off_line(const JointRange& range, std::span<const double> q) CELL_RT {
  const std::span<const double> qd = std::span(qd_).first(joints_);
  for (std::size_t i = 0; i < joints_; ++i) fastest_[i] = std::max(linear_.max_velocity()[i], std::abs(qd[i]));
  ptp_.brake_together(linear_.acceleration(), q, qd, range);
  activity_ = Activity::joints;
}

bool MoveExecutor::advance_linear(double dt, const JointRange& range, std::span<double> q) CELL_RT {
  const std::span<double> qd = std::span(qd_).first(joints_);
  const LinearMotion::Progress progress = linear_.advance(dt, q, qd);
  fastest_ = linear_.max_velocity();
  if (linear_.older_ended() && !braking_) end_through(state_.running - 1, Outcome::arrived);
  if (progress != LinearMotion::Progress::blocked) return progress == LinearMotion::Progress::arrived;
  // There is no path to brake on: the joints come to rest in the direction in which they move.
  if (!braking_) halt(Outcome::blocked);
  brake_ = false;
  braking_ = true;
  brake_off_line(range, q);
  return ptp_.advance(dt, q, qd);
}

// True when the activity has ended.
bool MoveExecutor::advance(double dt, const JointRange& range, std::span<double> q) CELL_RT {
  switch (activity_) {
    case Activity::joints:
      return ptp_.advance(dt, q, std::span(qd_).first(joints_));
    case Activity::linear:
      return advance_linear(dt, range, q);
    case Activity::delay:
      delay_left_ -= dt;
      return delay_left_ <= 0;
    case Activity::standing:
      break;
  }
  return true;
}

void MoveExecutor::arrive() CELL_RT {
  const std::uint32_t running = state_.running;
  const std::uint32_t halted = halt_through_;
  const bool braked = braking_;
  come_to_rest();
  if (halted != 0) end_through(halted, halt_outcome_);
  if (!braked) end_through(running, Outcome::arrived);
  if (state_.waiting > 0) state_.running = front().move.id;
}

bool MoveExecutor::step(double dt, const JointRange& range, std::span<double> q, std::span<double> qd) CELL_RT {
  if ((activity_ == Activity::standing || blend_) && state_.waiting > 0) start_front(range, q);
  if (activity_ == Activity::standing) {
    end_through(newest_, Outcome::blocked);  // refused, and nothing behind it
    state_.moving = false;
    state_.running = 0;
    return false;
  }
  if (brake_) brake(range, q);
  if (flies()) fly();
  if (advance(dt, range, q)) arrive();
  std::ranges::copy(std::span(qd_).first(joints_), qd.begin());
  // Until every id has ended: the next step tells of those that the queue refused.
  state_.moving = activity_ != Activity::standing || state_.waiting > 0 || state_.finished < newest_;
  return true;
}

}  // namespace cellmirror::motion
