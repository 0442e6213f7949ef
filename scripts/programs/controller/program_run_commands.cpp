// How a run carries out canonical commands.
#include <fmt/format.h>

#include <type_traits>
#include <variant>

#include "scripts/programs/controller/program_run.hpp"

namespace cellmirror::program {

namespace {

template <class What>
constexpr bool kAtEndOfMoves =
    std::is_same_v<What, OutputCommand> || std::is_same_v<What, ReleaseCommand> || std::is_same_v<What, ScriptCommand>;

}  // namespace

bool ProgramRun::carry_out() {
  const CanonicalCommand command = std::move(*pending_);
  pending_.reset();
  const Done done = std::visit(
      [&](const auto& what) {
        if constexpr (kAtEndOfMoves<std::decay_t<decltype(what)>>) {
          return carry_out_at_end(command);
        } else {
          return begin_to(what, command);
        }
      },
      command.what);
  if (done == Done::yes) return true;
  pending_ = command;
  return false;
}

bool ProgramRun::room() const { return moving_.size() < kRunAhead && context_.motion.room(robot_); }

ProgramRun::Done ProgramRun::begin_to(const MoveCommand& move, const CanonicalCommand& command) {
  if (!room()) return Done::not_yet;
  put_ahead(context_.motion.move(robot_, move, moving_.empty() ? due_ : Timestamp{}), command, move.fly);
  return Done::yes;
}

ProgramRun::Done ProgramRun::begin_to(const DelayCommand& delay, const CanonicalCommand& command) {
  if (!room()) return Done::not_yet;
  put_ahead(context_.motion.delay(robot_, delay.seconds, moving_.empty() ? due_ : Timestamp{}), command, false);
  return Done::yes;
}

// The moves before it end first: a move that cannot be done is not a reason to leave out those that can.
void ProgramRun::put_ahead(const Result<std::uint32_t>& ticket, const CanonicalCommand& command, bool fly) {
  if (!ticket) {
    fail_behind(command.statement, ticket.error());
    return;
  }
  const bool move = std::holds_alternative<MoveCommand>(command.what);
  moving_.push_back({*ticket, command.statement, move, fly});
  if (move) turned_.reset();
  if (move && stepping_) step_ticket_ = *ticket;
  report_command(ProgramEvent::Kind::command, context_.clock.now(), command, *ticket);
}

ProgramRun::Done ProgramRun::begin_to(const ToolCommand& tool, const CanonicalCommand& command) {
  if (!rested()) return Done::not_yet;
  newest_ = command.statement;
  report_command(ProgramEvent::Kind::command, due_, command);
  tool_set_ = true;
  if (auto set = context_.motion.set_tool(robot_, tool.X_PT); !set) {
    fail_now(error_text(command.statement, set.error()), command.statement);
    return Done::yes;
  }
  report_command(ProgramEvent::Kind::done, due_, command);
  return Done::yes;
}

ProgramRun::Done ProgramRun::begin_to(const WaitCommand& wait, const CanonicalCommand& command) {
  if (!rested()) return Done::not_yet;
  waiting_ = command;
  newest_ = command.statement;
  deadline_ = wait.timeout_s ? due_ + nanoseconds_of(*wait.timeout_s) : Timestamp{};
  phase_ = Phase::condition;
  report_command(ProgramEvent::Kind::command, due_, command);
  return Done::yes;
}

// The longest waiting program is served first, so even a free semaphore is not acquired here: Controllers grants it.
ProgramRun::Done ProgramRun::begin_to(const AcquireCommand& acquire, const CanonicalCommand& command) {
  if (!rested()) return Done::not_yet;
  waiting_ = command;
  newest_ = command.statement;
  semaphore_ = acquire.semaphore;
  phase_ = Phase::semaphore;
  report_command(ProgramEvent::Kind::command, due_, command);
  return Done::yes;
}

ProgramRun::Done ProgramRun::begin_to(const PauseCommand& /*pause*/, const CanonicalCommand& command) {
  if (!rested()) return Done::not_yet;
  newest_ = command.statement;
  report_command(ProgramEvent::Kind::command, due_, command);
  hold_here();
  return Done::yes;
}

ProgramRun::Done ProgramRun::begin_to(const RestCommand& /*rest*/, const CanonicalCommand& /*command*/) {
  return rested() ? Done::yes : Done::not_yet;
}

ProgramRun::Done ProgramRun::carry_out_at_end(const CanonicalCommand& command) {
  const bool flies = !moving_.empty() && moving_.back().fly;
  if (flies && deferred_.size() < kMostDeferred) {
    deferred_.push_back({moving_.back().ticket, command});
    report_command(ProgramEvent::Kind::command, context_.clock.now(), command);
    return Done::yes;
  }
  if (!rested() || !may_execute(command)) return Done::not_yet;
  report_command(ProgramEvent::Kind::command, due_, command);
  lent_ = true;
  execute(command, due_);
  // A move of this robot may be all that the comment has begun (MOVE_ROB): then there is no activity.
  lent_ = end_ == End::none && (!activities_.empty() || moved_by_comment(command));
  if (lent_) phase_ = Phase::activity;
  return Done::yes;
}

bool ProgramRun::moved_by_comment(const CanonicalCommand& command) const {
  return std::holds_alternative<ScriptCommand>(command.what) && context_.motion.progress(robot_).moving;
}

bool ProgramRun::may_execute(const CanonicalCommand& command) const {
  return scripts_left_ > 0 || !std::holds_alternative<ScriptCommand>(command.what);
}

// A refusal stops the robot at once: moves that were put ahead belong to a program that is wrong from here on.
void ProgramRun::execute(const CanonicalCommand& command, Timestamp when) {
  newest_ = command.statement;
  Result<void> done;
  if (const auto* output = std::get_if<OutputCommand>(&command.what)) done = execute(*output, when);
  if (const auto* release = std::get_if<ReleaseCommand>(&command.what)) done = execute(*release, when);
  if (const auto* script = std::get_if<ScriptCommand>(&command.what)) done = execute(*script, command.statement, when);
  if (end_ != End::none) return;  // the command has stopped its own program
  if (!done) {
    fail_now(error_text(command.statement, done.error()), command.statement);
    return;
  }
  report_command(ProgramEvent::Kind::done, when, command);
}

Result<void> ProgramRun::execute(const OutputCommand& output, Timestamp when) {
  if (output.number == 0 || output.number > kMostPorts) {
    return fail(fmt::format("there is no output {}", output.number), fmt::format("use 1 to {}", kMostPorts));
  }
  if (output.analogue) {
    signals_.analogue_outputs[output.number] = output.value;
  } else {
    signals_.digital_outputs[output.number] = output.value != 0;
  }
  signals_.changed = std::max(signals_.changed, when);
  return {};
}

Result<void> ProgramRun::execute(const ReleaseCommand& release, Timestamp when) {
  auto released = context_.semaphores.release(release.semaphore, when);
  if (!released) return released;
  const auto own = std::ranges::find(taken_, release.semaphore);
  if (own != taken_.end()) {
    taken_.erase(own);
  } else {
    context_.semaphores.make_up(release.semaphore);
  }
  return released;
}

Result<void> ProgramRun::execute(const ScriptCommand& script, StatementId statement, Timestamp when) {
  --scripts_left_;
  const std::string source =
      fmt::format("program {} of {}, line {}", loaded_->name, robot_, loaded_->program->place(statement).line);
  const Timestamp before = std::exchange(context_.script_instant, when);
  Result<ActivityHandle> begun = context_.scripts.execute(script.text, source);
  context_.script_instant = before;
  if (!begun) return std::unexpected(std::move(begun.error()));
  if (*begun) activities_.emplace_back(std::move(*begun), statement);
  return {};
}

}  // namespace cellmirror::program
