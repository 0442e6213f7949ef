// Hold, resume, step.
#include <fmt/format.h>

#include <algorithm>

#include "rt_core/base/contract.hpp"
#include "scripts/programs/controller/program_run.hpp"

namespace cellmirror::program {

Result<void> ProgramRun::hold() {
  if (held_ && !request_) {
    return fail(fmt::format("{} of {} is held already", loaded_->name, robot_), "continue with TF_RESUME or TF_STEP");
  }
  request_.reset();
  if (!held_) hold_here();
  return {};
}

void ProgramRun::hold_here() {
  stepping_ = false;
  step_ticket_ = 0;
  held_ = true;
  disturbed_ = true;
  held_since_ = context_.clock.now();
  if (auto slowed = context_.motion.set_pace(robot_, 0); !slowed) {
    fail_now(slowed.error().text());
    return;
  }
  report(ProgramEvent::Kind::held, held_since_);
}

Result<void> ProgramRun::resume() {
  if (stepping_) hold_here();
  if (!held_) return fail(fmt::format("{} of {} is not held", loaded_->name, robot_), "hold it with TF_HOLD");
  if (machine_.direction() != direction_) {
    if (auto turned = turn(direction_); !turned) return turned;
  }
  request_ = Request{false, request_ && request_->stopping};
  if (!forget_ahead_) go();
  return {};
}

Result<void> ProgramRun::step(Direction direction) {
  if (!held_) return fail(fmt::format("{} of {} is not held", loaded_->name, robot_), "hold it with TF_HOLD");
  if (request_)
    return fail(fmt::format("{} of {} is about to continue", loaded_->name, robot_), "wait until it is held");
  if (direction == Direction::backward && !loaded_->program->reversible) {
    return fail(fmt::format("{} cannot go backward: only programs of check points can", loaded_->name),
                "use jet_boom or jet_tarm files, or step FORWARD");
  }
  if (machine_.direction() != direction) {
    if (auto turned = turn(direction); !turned) return turned;
  }
  request_ = Request{true, false};
  return {};
}

// The robot reverses once it is at rest: until then it may reach the next check point.
Result<void> ProgramRun::turn(Direction direction) {
  const bool moved = turned_ || at_ || first_move_ahead() != 0;
  if (!moved) return fail(fmt::format("{} of {} has not moved yet", loaded_->name, robot_), "step FORWARD");
  const Direction before = machine_.direction();
  if (auto turned = machine_.set_direction(direction); !turned) return turned;
  if (went_ == direction) {  // taken back: all that is ahead is wanted again
    went_.reset();
    forget_ahead_ = false;
    return {};
  }
  if (!forget_ahead_) went_ = before;
  forget_ahead_ = true;
  return {};
}

// The first command in this direction that has not been carried out or come to its end.
std::optional<StatementId> ProgramRun::first_undone(Direction direction) const {
  const bool forward = direction == Direction::forward;
  std::optional<StatementId> first;
  const auto consider = [&](StatementId statement) {
    if (!first || (forward ? statement < *first : statement > *first)) first = statement;
  };
  if (forward) consider(machine_.position());
  if (!moving_.empty()) consider(moving_.front().statement);
  if (!deferred_.empty()) consider(deferred_.front().command.statement);
  if (pending_) consider(pending_->statement);
  if (closing_ && closing_->at) consider(*closing_->at);
  return first;
}

void ProgramRun::forget_ahead() {
  if (!went_) return;  // forgotten already, and nothing was given since
  const auto ahead = std::find_if(moving_.begin(), moving_.end(), [](const Moving& moving) { return moving.move; });
  if (ahead != moving_.end()) {
    turned_ = Turned{ahead->statement, {}};
  } else if (!turned_) {
    turned_ = Turned{*at_, {}};
  }
  if (const auto undone = first_undone(*went_)) turned_->next[static_cast<std::size_t>(*went_)] = undone;
  went_.reset();
  moving_.clear();
  pending_.reset();
  closing_.reset();
  deferred_.clear();
  activities_.clear();
  waiting_.reset();
  semaphore_.clear();
  lent_ = false;
  phase_ = Phase::running;
}

// The machine was ahead of the robot by what has been forgotten.
void ProgramRun::put_machine_at_robot() {
  const auto next = turned_->next[static_cast<std::size_t>(machine_.direction())];
  const Result<void> put = next ? machine_.go_on_with(*next) : machine_.stand_at(turned_->check_point);
  CELLMIRROR_EXPECTS(put.has_value());
}

bool ProgramRun::settle() {
  const MotionProgress progress = context_.motion.progress(robot_);
  if (!request_->stopping) {
    if (progress.moving && progress.pace > 0) return false;
    if (!forget_ahead_) {
      go();
      return true;
    }
    if (auto stopped = context_.motion.stop(robot_); !stopped) {
      fail_now(stopped.error().text());
      return true;
    }
    forget_ahead();
    request_->stopping = true;
    return true;
  }
  if (progress.moving) return false;
  put_machine_at_robot();
  forget_ahead_ = false;
  go();
  return true;
}

void ProgramRun::go() {
  const bool step = request_ && request_->step;
  request_.reset();
  const Timestamp now = context_.clock.now();
  const Nanoseconds held = now - held_since_;
  held_time_ += held;
  if (phase_ == Phase::delayed) until_ = until_ + held;
  if (phase_ == Phase::condition && deadline_.known()) deadline_ = deadline_ + held;
  resumed_ = now;
  if (phase_ != Phase::semaphore) due_ = std::max(due_, now);  // a waiting one keeps its turn
  stepping_ = step;
  step_ticket_ = step ? first_move_ahead() : 0;
  held_ = false;
  report(ProgramEvent::Kind::resumed, now);
  if (auto gated = context_.motion.hold_behind(robot_, step_ticket_); !gated) {
    fail_now(gated.error().text());
    return;
  }
  if (auto paced = context_.motion.set_pace(robot_, 1); !paced) fail_now(paced.error().text());
}

std::uint32_t ProgramRun::first_move_ahead() const {
  const auto ahead = std::find_if(moving_.begin(), moving_.end(), [](const Moving& moving) { return moving.move; });
  return ahead == moving_.end() ? 0 : ahead->ticket;
}

bool ProgramRun::step_is_over() const { return step_ticket_ != 0 && finished_ >= step_ticket_; }

}  // namespace cellmirror::program
