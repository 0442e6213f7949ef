#include "scripts/programs/controller/program_run.hpp"

#include <fmt/format.h>

#include <array>

#include "rt_core/base/contract.hpp"
#include "scripts/programs/program/trace.hpp"

namespace cellmirror::program {

ProgramRun::ProgramRun(RunContext& context, std::string robot, SignalBoard& signals,
                       std::shared_ptr<LoadedProgram> loaded, Direction direction, Timestamp begin)
    : context_(context),
      robot_(std::move(robot)),
      signals_(signals),
      loaded_(std::move(loaded)),
      direction_(direction),
      machine_(loaded_->program, context.motion.joint_kinds(robot_)),
      started_(begin),
      until_(begin + nanoseconds_of(context.motion.program_delay(robot_))),
      due_(begin) {
  loaded_->direction = direction;
  loaded_->error.clear();
  ++loaded_->runs;
  if (direction == Direction::backward) {
    const Result<void> turned = machine_.set_direction(direction);
    CELLMIRROR_EXPECTS(turned.has_value());
  }
  report(ProgramEvent::Kind::started, begin);
}

void ProgramRun::begin_turn() {
  statements_left_ = kStatements;
  scripts_left_ = kScripts;
}

bool ProgramRun::follow() {
  bool any = collect();
  if (end_ == End::none && request_ && settle()) any = true;
  while (end_ == End::none && !held_ && go_on()) any = true;
  return any;
}

bool ProgramRun::collect() {
  if (moving_.empty()) return false;
  const MotionProgress progress = context_.motion.progress(robot_);
  if (moving_.front().ticket > progress.finished) return false;
  finished_time_ = progress.finished_time.known() ? progress.finished_time : context_.clock.now();
  if (progress.end != MotionProgress::End::arrived) {
    const Error why = progress.end == MotionProgress::End::blocked
                          ? Error{fmt::format("{} could not continue this move", robot_),
                                  "check limits and singular postures on its path"}
                          : Error{fmt::format("another command has ended this move of {}", robot_), {}};
    fail_now(error_text(moving_.front().statement, why), moving_.front().statement);
    return true;
  }
  while (!moving_.empty() && moving_.front().ticket <= progress.finished) {
    const Moving ended = moving_.front();
    moving_.pop_front();
    finished_ = ended.ticket;
    if (ended.move) at_ = ended.statement;
    newest_ = ended.statement;
    report(ProgramEvent::Kind::move_ended, finished_time_, {}, ended.ticket);
  }
  if (moving_.empty()) due_ = std::max(due_, deferred_instant());
  return true;
}

bool ProgramRun::go_on() {
  if (run_deferred() || check_activities()) return true;
  if (stepping_ && step_is_over()) {
    hold_here();
    return true;
  }
  switch (phase_) {
    case Phase::delayed:
      return begin();
    case Phase::condition:
      return check_condition();
    case Phase::semaphore:
    case Phase::activity:
      return false;
    case Phase::running:
      break;
  }
  if (stepping_ && step_ticket_ != 0) return false;
  if (pending_) return carry_out();
  if (closing_) return close();
  return fetch();
}

bool ProgramRun::begin() {
  if (context_.clock.now() < until_) return false;
  // What moved the robot before has to be over: a move begins where the robot rests.
  const MotionProgress progress = context_.motion.progress(robot_);
  if (progress.moving) return false;
  due_ = std::max(until_, progress.finished_time);
  phase_ = Phase::running;
  return true;
}

bool ProgramRun::run_deferred() {
  if (deferred_.empty() || deferred_.front().ticket > finished_ || !may_execute(deferred_.front().command)) {
    return false;
  }
  const CanonicalCommand command = std::move(deferred_.front().command);
  deferred_.pop_front();
  execute(command, deferred_instant());
  return true;
}

bool ProgramRun::check_activities() {
  bool any = false;
  while (!activities_.empty()) {
    const auto& [activity, statement] = activities_.front();
    if (activity->state() == Activity::State::running) return any;
    if (activity->state() == Activity::State::refused) {
      fail_now(error_text(statement, activity->error()), statement);
      return true;
    }
    activities_.pop_front();
    any = true;
  }
  if (phase_ != Phase::activity) return any;
  if (any) due_ = std::max(due_, context_.clock.now());
  const MotionProgress progress = context_.motion.progress(robot_);
  if (progress.moving) return any;
  phase_ = Phase::running;
  lent_ = false;
  due_ = std::max(due_, progress.finished_time);
  return any;
}

bool ProgramRun::check_condition() {
  if (machine_.holds(*this)) {
    due_ = std::max({due_, signals_.changed, resumed_});
  } else if (deadline_.known() && context_.clock.now() >= deadline_) {
    machine_.time_out();
    due_ = std::max(due_, deadline_);
  } else {
    return false;
  }
  phase_ = Phase::running;
  report_command(ProgramEvent::Kind::done, due_, *waiting_);
  waiting_.reset();
  return true;
}

void ProgramRun::grant(Timestamp when) {
  due_ = std::max({due_, when, resumed_});
  taken_.push_back(std::exchange(semaphore_, {}));
  phase_ = Phase::running;
  report_command(ProgramEvent::Kind::done, due_, *waiting_);
  waiting_.reset();
}

bool ProgramRun::fetch() {
  if (statements_left_ == 0) return false;
  const std::uint64_t before = machine_.executed();
  const Machine::Step step = machine_.next(*this, statements_left_);
  const std::uint64_t executed = std::max<std::uint64_t>(1, machine_.executed() - before);
  statements_left_ -= std::min<std::uint64_t>(statements_left_, executed);
  switch (step) {
    case Machine::Step::command:
      pending_ = machine_.command();
      return true;
    case Machine::Step::spent:
      // Where it computes: an endless loop is to be found.
      if (machine_.position() < loaded_->program->statements.size()) newest_ = machine_.position();
      return true;
    case Machine::Step::ended:
      // Stepped back to where it began: there it stays, to be stepped or resumed.
      if (machine_.direction() != direction_) {
        if (rested()) hold_here();
        return held_;
      }
      closing_ = Closing{};
      return true;
    case Machine::Step::failed:
      closing_ = Closing{End::failed, machine_.error().text(), failed_statement()};
      return true;
  }
  return false;
}

// The machine is at it or after it.
std::optional<StatementId> ProgramRun::failed_statement() const {
  const Program& program = *loaded_->program;
  for (const StatementId back : {0U, 1U}) {
    if (machine_.position() < back || machine_.position() - back >= program.statements.size()) continue;
    const StatementId candidate = machine_.position() - back;
    if (program.place(candidate).line == machine_.error().place.line) return candidate;
  }
  return newest_;
}

bool ProgramRun::close() {
  if (!rested()) return false;
  const Closing closing = std::move(*closing_);
  loaded_->error = closing.why;
  if (closing.at) newest_ = closing.at;
  finish(closing.end, due_);
  return true;
}

void ProgramRun::fail_behind(StatementId statement, const Error& why) {
  if (!closing_) closing_ = Closing{End::failed, error_text(statement, why), statement};
}

void ProgramRun::fail_now(std::string why, std::optional<StatementId> at) {
  if (end_ != End::none) return;
  loaded_->error = std::move(why);
  // A refusal to brake leaves nothing that could be done beside: the program ends for the reason that it has.
  if (!moving_.empty()) static_cast<void>(context_.motion.stop(robot_));
  if (at) {
    moving_.clear();
    waiting_.reset();
    newest_ = at;
  }
  finish(End::failed, std::max(due_, context_.clock.now()));
}

void ProgramRun::stop() {
  if (end_ != End::none) return;
  static_cast<void>(context_.motion.stop(robot_));
  finish(End::stopped, std::max(due_, context_.instant()));
}

void ProgramRun::finish(End end, Timestamp when) {
  due_ = when;
  loaded_->elapsed_s = elapsed_s();
  loaded_->step = step_name();
  loaded_->line = line();
  end_ = end;
  if (disturbed_) {
    static_cast<void>(context_.motion.hold_behind(robot_, 0));
    static_cast<void>(context_.motion.set_pace(robot_, 1));
  }
  if (tool_set_) static_cast<void>(context_.motion.set_tool(robot_, std::nullopt));
  if (undisturbed()) {
    (direction_ == Direction::forward ? loaded_->expected_forward_s : loaded_->expected_backward_s) =
        loaded_->elapsed_s;
  }
  constexpr std::array kStates = {ProgramState::running, ProgramState::ended, ProgramState::stopped,
                                  ProgramState::failed};
  constexpr std::array kEvents = {ProgramEvent::Kind::started, ProgramEvent::Kind::ended, ProgramEvent::Kind::stopped,
                                  ProgramEvent::Kind::failed};
  loaded_->state = kStates[static_cast<std::size_t>(end)];
  const std::string kept = keep_semaphores(end);
  report(kEvents[static_cast<std::size_t>(end)], when, end == End::failed ? loaded_->error : kept);
}

// A stopped program releases nothing: its robot is in the protected space. A program that only acquires, as a signal
// from another program, keeps nothing. Returns the text for reports.
std::string ProgramRun::keep_semaphores(End end) {
  std::string text;
  if (end == End::ended) return text;
  const std::string who = fmt::format("{} {} {}", robot_, loaded_->name, end == End::failed ? "failed" : "was stopped");
  for (const std::string& semaphore : taken_) {
    if (!loaded_->releases(semaphore)) continue;
    context_.semaphores.keep(semaphore, who);
    text += fmt::format("{}{}", text.empty() ? "before it released semaphore " : ", ", semaphore);
  }
  return text;
}

std::string ProgramRun::error_text(StatementId statement, const Error& why) const {
  return Diagnostic{Severity::error, loaded_->program->place(statement), why.what, why.remedy}.text();
}

void ProgramRun::report(ProgramEvent::Kind kind, Timestamp when, std::string text, std::uint32_t ticket) {
  if (!context_.event) return;
  context_.event({kind, when, robot_, loaded_->name, std::move(text), ticket, line()});
}

void ProgramRun::report_command(ProgramEvent::Kind kind, Timestamp when, const CanonicalCommand& command,
                                std::uint32_t ticket) {
  if (!context_.event) return;
  const auto place_line = static_cast<std::uint32_t>(loaded_->program->place(command.statement).line);
  context_.event({kind, when, robot_, loaded_->name, trace_line(*loaded_->program, command), ticket, place_line});
}

std::optional<StatementId> ProgramRun::statement() const {
  if (!moving_.empty()) return moving_.front().statement;
  if (waiting_) return waiting_->statement;
  return newest_;
}

std::string ProgramRun::step_name() const {
  const auto current = statement();
  return current ? loaded_->program->step_name(*current) : std::string{};
}

std::uint32_t ProgramRun::line() const {
  const auto current = statement();
  return current ? static_cast<std::uint32_t>(loaded_->program->place(*current).line) : 0;
}

ProgramState ProgramRun::state() const {
  if (end_ != End::none) return loaded_->state;
  if (held_) return ProgramState::held;
  if (phase_ == Phase::delayed) return ProgramState::delayed;
  return phase_ == Phase::running ? ProgramState::running : ProgramState::waiting;
}

std::string ProgramRun::waits_for() const {
  if (phase_ == Phase::semaphore) return fmt::format("semaphore {}", semaphore_);
  if (phase_ == Phase::condition) return std::get<WaitCommand>(waiting_->what).condition;
  if (phase_ == Phase::activity) return "its SCRIPT command";
  return {};
}

double ProgramRun::elapsed_s() const {
  if (end_ != End::none) return loaded_->elapsed_s;
  const bool over = closing_ && rested();
  const Timestamp now = over ? due_ : context_.clock.now();
  Nanoseconds elapsed = std::max(now, started_) - started_ - held_time_;
  if (held_) elapsed -= context_.clock.now() - held_since_;
  return std::max(0.0, seconds(elapsed));
}

}  // namespace cellmirror::program
