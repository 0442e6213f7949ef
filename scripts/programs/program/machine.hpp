// Executes one program: statement by statement, without a clock, a robot or a thread. The caller executes the emitted
// commands and says when to continue.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "rt_core/base/diagnostics.hpp"
#include "rt_core/base/result.hpp"
#include "rt_core/ports/robot_state.hpp"
#include "scripts/programs/program/canonical.hpp"
#include "scripts/programs/program/program.hpp"

namespace cellmirror::program {

// World of expressions: the robot that executes the program, and its inputs and outputs.
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

// One thread. Real-time class: worker threads. Memory: that of the variables, and a few kilobytes.
class Machine {
 public:
  // `joints`: of the robot; what the units of joint values become. The program must have been checked
  // (check_program()) and be fit for the robot (Program::check_for()).
  Machine(std::shared_ptr<const Program> program, std::span<const JointKind> joints);

  enum class Step : std::uint8_t {
    command,  // command() is to be carried out; then next() again. A delay, and a move that may be followed by others,
              // need not have ended before (RestCommand comes where it must)
    spent,    // the budget is spent: an endless loop, or much to compute. next() continues
    ended,
    failed,  // error(): what is wrong with which statement
  };
  // Executes at most `budget` statements.
  Step next(const ProgramWorld& world, std::size_t budget);
  [[nodiscard]] const CanonicalCommand& command() const { return command_; }
  [[nodiscard]] const Diagnostic& error() const { return error_; }

  // The condition of the newest WaitCommand; next() may be called when it is true. An error counts as true and fails
  // the machine: next() reports it.
  [[nodiscard]] bool holds(const ProgramWorld& world);
  // The newest WaitCommand has timed out. next() continues with the statement's reaction, which may be an error.
  void time_out();

  // Reversible programs: check points one by one in reverse order, from the program's position, each with the
  // velocities of its leg. Everything else is skipped backward. Before the first next(): from the end of the program
  // (TF_BACK). After its end in one direction it continues in the other. Refused for other programs and after an error.
  Result<void> set_direction(Direction direction);
  [[nodiscard]] Direction direction() const { return direction_; }
  // Reversible programs: the robot is at, or moving to, the check point of this statement (of an emitted command);
  // later commands have been discarded. next() continues from there.
  Result<void> stand_at(StatementId check_point);
  // Reversible programs: next() continues with this statement in the present direction. Backward: with this check
  // point.
  Result<void> go_on_with(StatementId statement);

  // The statement that next() will execute; the size of the program at its end.
  [[nodiscard]] StatementId position() const { return position_; }
  [[nodiscard]] const Program& program() const { return *program_; }
  // A variable, or the first element of a list; null if there is none of that name. Tests and status.
  [[nodiscard]] const Value* variable(std::string_view name) const;
  [[nodiscard]] std::uint64_t executed() const { return executed_; }  // statements

 private:
  // What a statement leads to: on with the next one, a command, the end, or an error in error_.
  enum class Outcome : std::uint8_t { go_on, command, ended, failed };
  struct CheckPoint {
    StatementId statement = 0;
    MotionSettings settings;  // in force on the way to it
  };
  struct Execute;  // machine_statements.cpp

  Outcome execute(const ProgramWorld& world);
  void end_wait();
  Step failed(StatementId statement, const Error& why);
  [[nodiscard]] bool looks(const Statement& statement) const;
  Result<void> evaluate_node(const ProgramWorld& world, const ExpressionNode& node);
  Result<void> evaluate_operands(const ProgramWorld& world, const ExpressionNode& node);
  Result<Value> element(const ExpressionNode& node, const Value& index) const;
  Result<Value> look(const ProgramWorld& world, const ExpressionNode& node, const Value* operand) const;
  Result<Value> evaluate(const ProgramWorld& world, ExpressionId id);
  Result<double> evaluate_number(const ProgramWorld& world, ExpressionId id);
  Result<Target> evaluate_target(const ProgramWorld& world, TargetKind kind, ExpressionId id);
  Result<std::size_t> value_place(VariableId variable, const Value* index) const;
  Result<void> apply_setting(Setting setting, std::optional<double> value);
  Step next_backward(const ProgramWorld& world);
  void find_check_points();
  void find_settings();

  std::shared_ptr<const Program> program_;
  std::vector<JointKind> joints_;
  std::vector<bool> looks_;               // expressions that use the world
  std::vector<Value> values_;             // of all variables, list elements behind each other
  std::vector<std::size_t> first_value_;  // by variable
  std::vector<Value> stack_;              // of operands, while an expression is evaluated
  std::vector<StatementId> calls_;
  StatementId position_ = 0;
  Direction direction_ = Direction::forward;
  MotionSettings settings_;
  Pose X_ZU_ = Pose::Identity();
  bool rested_ = false;  // nothing moves since the last RestCommand
  bool failed_ = false;
  std::optional<StatementId> waiting_;  // the newest WaitCommand
  bool timed_out_ = false;
  std::vector<CheckPoint> check_points_;  // of reversible programs, once they are run backward
  bool behind_end_ = false;               // backward from the end, and the last check point is to be given
  CanonicalCommand command_;
  Diagnostic error_;
  std::uint64_t executed_ = 0;
};

}  // namespace cellmirror::program
