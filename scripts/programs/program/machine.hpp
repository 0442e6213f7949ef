// Executes one program: statement by statement, without a clock, a robot or a thread. Whoever drives it carries out the
// commands that come out and says when to go on.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "rt_core/base/diagnostics.hpp"
#include "rt_core/base/result.hpp"
#include "rt_core/ports/robot_state.hpp"
#include "scripts/programs/program/canonical.hpp"
#include "scripts/programs/program/program.hpp"

namespace cellmirror::program {

// What expressions look at: the robot that executes the program, and its inputs and outputs.
class ProgramWorld {
 public:
  virtual ~ProgramWorld() = default;
  [[nodiscard]] virtual JointValues joints() const = 0;     // rad or m
  [[nodiscard]] virtual Result<Pose> position() const = 0;  // X_ZT
  // Numbers from 1; those beyond kMostPorts are refused before.
  [[nodiscard]] virtual bool digital_input(std::size_t number) const = 0;
  [[nodiscard]] virtual double analogue_input(std::size_t number) const = 0;
  [[nodiscard]] virtual bool digital_output(std::size_t number) const = 0;
  [[nodiscard]] virtual double analogue_output(std::size_t number) const = 0;
};

enum class Direction : std::uint8_t { forward, backward };

// One thread. Real-time class: worker threads.
class Machine {
 public:
  // `joints`: of the robot; what the units of joint values become. The program must be fit for it
  // (Program::check_for()).
  Machine(std::shared_ptr<const Program> program, std::span<const JointKind> joints);

  enum class Step : std::uint8_t {
    command,  // command() is to be carried out; then next() again. A delay, and a move that may be followed by others,
              // need not have ended before (RestCommand comes where it must)
    spent,  // the budget is spent: an endless loop, or much to compute. next() goes on
    ended,
    failed,  // error(): what is wrong with which statement
  };
  // Executes at most `budget` statements.
  Step next(const ProgramWorld& world, std::size_t budget);
  [[nodiscard]] const CanonicalCommand& command() const { return command_; }
  [[nodiscard]] const Diagnostic& error() const { return error_; }

  // The condition of the newest WaitCommand. An error fails the machine: next() tells.
  [[nodiscard]] bool holds(const ProgramWorld& world);
  // The time of the newest WaitCommand is over. next() goes on with what the statement says of that, which may be an
  // error.
  void time_out();

  // Reversible programs: check points one by one in the other order, from where the program stands. Comments and
  // outputs are passed over backward. Refused for other programs.
  Result<void> set_direction(Direction direction);
  [[nodiscard]] Direction direction() const { return direction_; }

  // The statement that next() will execute; the size of the program at its end.
  [[nodiscard]] StatementId position() const { return position_; }
  [[nodiscard]] const Program& program() const { return *program_; }
  // Of variables; tests and status.
  [[nodiscard]] const Value* variable(std::string_view name) const;
  [[nodiscard]] std::uint64_t executed() const { return executed_; }  // statements

 private:
  std::shared_ptr<const Program> program_;
  std::vector<JointKind> joints_;
  std::vector<std::vector<Value>> variables_;
  std::vector<StatementId> calls_;
  StatementId position_ = 0;
  Direction direction_ = Direction::forward;
  MotionSettings settings_;
  Pose X_ZU_ = Pose::Identity();
  bool rested_ = false;
  CanonicalCommand command_;
  Diagnostic error_;
  std::uint64_t executed_ = 0;
};

}  // namespace cellmirror::program
