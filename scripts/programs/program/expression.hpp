// Expressions of robot programs: trees whose nodes lie in one array of the program. Types are checked while they are
// evaluated; a language that knows its types checks them earlier.
#pragma once

#include <cstdint>
#include <string_view>

namespace cellmirror::program {

using ExpressionId = std::uint32_t;  // index of a node
inline constexpr ExpressionId kNoExpression = 0xFFFFFFFFU;

enum class Operator : std::uint8_t {
  // leaves; `payload` says which
  constant,  // of Program::constants
  variable,  // of Program::variables
  // world; the machine waits for the robot to stand before it looks
  current_joints,    // JointPosition, SI
  current_position,  // X_UT: the TCP in the program's zero point
  digital_input,     // (number) boolean
  analogue_input,    // (number) real
  digital_output,    // (number) boolean, as the program or another has set it last
  analogue_output,   // (number) real
  // (a): lists count from the lower bound of the variable, `payload`
  element,  // (index) of the list `payload`
  // arithmetic; integers stay integers, an integer beside a real becomes one; overflow, division by 0 and results that
  // are not
  // finite are errors where they occur
  negate,
  add,
  subtract,
  multiply,
  divide,          // always a real
  integer_divide,  // rounds towards 0
  modulo,          // sign of the dividend
  power,
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
  round,     // to the nearest integer, halves away from 0
  truncate,  // to an integer
  to_real,
  // comparisons; reals compare exactly
  equal,
  not_equal,
  less,
  less_equal,
  greater,
  greater_equal,
  // booleans, and integers bit by bit
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

struct ExpressionNode {
  Operator which = Operator::constant;
  std::uint8_t operands = 0;
  std::uint32_t first_operand = 0;  // in Program::operands
  std::uint32_t payload = 0;
};

}  // namespace cellmirror::program
