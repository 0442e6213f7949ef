// Expressions of robot programs: trees whose nodes are in one array of the program. Types are checked while they are
// evaluated; a typed language checks them earlier.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include "rt_core/base/result.hpp"
#include "scripts/programs/program/value.hpp"

namespace cellmirror::program {

using ExpressionId = std::uint32_t;  // index of a node
inline constexpr ExpressionId kNoExpression = 0xFFFFFFFFU;

enum class Operator : std::uint8_t {
  // leaves; `payload` says which
  constant,  // of Program::constants
  variable,  // of Program::variables
  // world; the machine waits for the robot to rest before it reads it
  current_joints,    // JointPosition; `payload`: its JointUnits
  current_position,  // X_UT: the TCP in the program's zero point
  digital_input,     // (number) boolean
  analogue_input,    // (number) real
  digital_output,    // (number) boolean, as the program or another has set it last
  analogue_output,   // (number) real
  // (a): lists count from the lower bound of the variable, `payload`
  element,  // (index) of the list `payload`
  // arithmetic; integers stay integers, an integer beside a real becomes one; overflow, division by 0 and results that
  // are not finite are errors where they occur
  negate,
  add,
  subtract,
  multiply,
  divide,          // always a real
  integer_divide,  // of integers; rounds towards 0
  modulo,          // of integers; sign of the dividend
  power,           // always a real
  absolute,
  square_root,
  sine,  // angles in radians: languages that write degrees multiply
  cosine,
  tangent,
  arc_sine,
  arc_cosine,
  arc_tangent,  // (y, x)
  minimum,
  maximum,
  round,     // to the nearest integer, halves away from 0; an integer
  truncate,  // to an integer
  to_real,
  // comparisons of numbers; reals compare exactly; equal and not_equal take booleans too
  equal,
  not_equal,
  less,
  less_equal,
  greater,
  greater_equal,
  // booleans, and integers bit by bit; both operands are evaluated always
  logical_and,
  logical_or,
  logical_xor,
  logical_not,
  // poses (m, rad; roll, pitch, yaw as in rt_core/base/pose.hpp)
  make_pose,  // (x, y, z, roll, pitch, yaw)
  compose,    // (X_AB, X_BC) = X_AC
  inverse,
  component,  // (pose or joints) `payload`: 0..5 x y z roll pitch yaw; joints: 0.. in the units of the value
  // joints
  make_joints,  // (a, b, ...): `payload` says the units, as JointUnits
};
[[nodiscard]] std::string_view name_of(Operator which);

// How many operands it takes; make_joints: 1 .. kMaxJointsPerRobot.
struct Arity {
  std::uint8_t least = 0;
  std::uint8_t most = 0;
};
[[nodiscard]] Arity arity_of(Operator which);
// Whether the value depends on the robot or on what is connected to it.
[[nodiscard]] bool reads_world(Operator which);
// The type of the result for operands of these types. Refused: types that it does not take. Not for constant, variable
// and element, whose types are those of what they name.
[[nodiscard]] Result<ValueType> result_type(Operator which, std::span<const ValueType> operands);
// The result of an expression without variables and world. Refused: overflow, division by 0, not finite, a missing
// component.
[[nodiscard]] Result<Value> apply(Operator which, std::span<const Value> operands, std::uint32_t payload);

// The operands of a node come before it in the array.
struct ExpressionNode {
  Operator which = Operator::constant;
  std::uint8_t operands = 0;
  std::uint32_t first_operand = 0;  // in Program::operands
  std::uint32_t payload = 0;
};

}  // namespace cellmirror::program
