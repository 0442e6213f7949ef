// A robot program in the form that every language is translated to: a list of statements for the machine. It is
// independent of the robot and may be loaded for several. Immutable once made (ProgramBuilder).
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "rt_core/base/diagnostics.hpp"
#include "rt_core/ports/robot_state.hpp"
#include "scripts/programs/program/canonical.hpp"
#include "scripts/programs/program/expression.hpp"
#include "scripts/programs/program/value.hpp"

namespace cellmirror::program {

// Beyond these a program is refused, with the number.
inline constexpr std::size_t kMostStatements = 2'000'000;
inline constexpr std::size_t kMostListElements = 100'000;  // of all lists together
inline constexpr std::size_t kMostCalls = 64;              // of subprograms within each other
inline constexpr std::size_t kMostExpressionDepth = 64;    // nodes above each other: evaluation is recursive
inline constexpr std::size_t kMostPorts = 1024;            // inputs, outputs: numbers 1 ..
inline constexpr std::size_t kMostVariables = 100'000;
inline constexpr std::size_t kMostSemaphores = 1024;  // of one program
inline constexpr double kLongestTime_s = 1e6;         // of a delay or a timeout

using StatementId = std::uint32_t;
using VariableId = std::uint32_t;
using TextId = std::uint32_t;  // of Program::texts
inline constexpr std::uint32_t kNone = 0xFFFFFFFFU;

enum class Setting : std::uint8_t {
  joint_velocity,  // units and meaning as in MotionSettings; the value may not be set back but by the default below
  joint_acceleration,
  linear_velocity,
  linear_acceleration,
  rotational_velocity,
  rotational_acceleration,
  linear_velocity_share,  // takes the place of linear_velocity, and the other way round; so do these three
  linear_acceleration_share,
  rotational_velocity_share,
  rotational_acceleration_share,
  fly_speed_fraction,  // the three set type and parameter
  fly_distance,        // m
  fly_angle,           // rad
  tool,                // a pose X_PT: a ToolCommand
  zero_point,          // a pose X_ZU: poses of the program are in U from now on
};

struct MoveStatement {
  PathKind path = PathKind::joints;
  TargetKind kind = TargetKind::joints_absolute;
  bool fly = false;
  // Joints or a pose, by the kind; a pose is in the program's zero point (pose_relative: in its axes).
  ExpressionId target = kNoExpression;
  ExpressionId via = kNoExpression;
};
struct AssignStatement {
  VariableId variable = 0;
  ExpressionId index = kNoExpression;  // of a list
  std::uint32_t component = kNone;     // of a pose (0..5) or of joints
  ExpressionId value = kNoExpression;
};
struct JumpStatement {
  StatementId target = 0;
};
struct BranchStatement {  // on when the condition is true, else to the target
  ExpressionId condition = kNoExpression;
  StatementId target = 0;
};
struct CallStatement {
  StatementId target = 0;
};
struct ReturnStatement {};
struct EndStatement {};
struct PauseStatement {};
struct DelayStatement {
  ExpressionId seconds = kNoExpression;
};
struct WaitStatement {
  ExpressionId condition = kNoExpression;
  ExpressionId timeout_s = kNoExpression;  // none: for ever
  VariableId timed_out = kNone;            // a boolean that says so; none: a timeout is an error
  TextId text = kNone;                     // of the condition, for people
};
struct OutputStatement {
  bool analogue = false;
  ExpressionId number = kNoExpression;
  ExpressionId value = kNoExpression;
};
struct SemaphoreStatement {
  bool acquire = false;
  TextId name = kNone;
};
struct ScriptStatement {
  TextId text = kNone;
};
struct SetStatement {
  Setting setting = Setting::joint_velocity;
  ExpressionId value = kNoExpression;  // none: the robot's own parameter again
};

using Statement = std::variant<MoveStatement, AssignStatement, JumpStatement, BranchStatement, CallStatement,
                               ReturnStatement, EndStatement, PauseStatement, DelayStatement, WaitStatement,
                               OutputStatement, SemaphoreStatement, ScriptStatement, SetStatement>;

struct StatementPlace {
  std::uint32_t line = 0;
  std::uint16_t column = 0;
  TextId label = kNone;  // number of the record, name of the check point: what people call this step
};

struct Variable {
  std::string name;
  ValueType type = ValueType::real;
  bool list = false;
  std::int64_t first = 1;      // index of the first element
  std::vector<Value> initial;  // one, or the elements of a list; all of the type
};

// A semaphore is known by its name to all programs of the cell. The first program that is loaded with it makes it.
struct SemaphoreDeclaration {
  std::string name;
  std::uint32_t initial = 0;
  std::uint32_t line = 0;
};

class Program {
 public:
  // By ProgramBuilder.
  std::string name;      // as the header says, or the file's name
  std::string language;  // "irdata", ...
  std::string file;      // for diagnostics
  // May be run backward as well: only moves to absolute targets, settings of motion, delays, outputs, SCRIPT commands
  // and pauses; moves and settings with constants.
  bool reversible = false;
  std::vector<Statement> statements;
  std::vector<StatementPlace> places;  // one a statement
  std::vector<ExpressionNode> expressions;
  std::vector<ExpressionId> operands;
  std::vector<Value> constants;
  std::vector<Variable> variables;
  std::vector<std::string> texts;
  std::vector<SemaphoreDeclaration> semaphores;

  // What does not fit a robot with these joints: moves to more joints than it has. For TF_LOAD and check --robot.
  void check_for(std::span<const JointKind> joints, Diagnostics& diagnostics) const;
  [[nodiscard]] Place place(StatementId statement) const;
  // "N40", "check point P3", or "line 12".
  [[nodiscard]] std::string step_name(StatementId statement) const;
  [[nodiscard]] bool releases(std::string_view semaphore) const;  // whether any statement does
};

// "fetch" of "programs/fetch.src": the name of a program whose text has none.
[[nodiscard]] std::string name_of_file(std::string_view file);

}  // namespace cellmirror::program
