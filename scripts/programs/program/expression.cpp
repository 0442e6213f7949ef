#include "scripts/programs/program/expression.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string>

#include "rt_core/base/capacity.hpp"

namespace cellmirror::program {
namespace {

// What an operator takes.
enum class Takes : std::uint8_t {
  nothing,
  one_integer,     // the number of an input or output
  numbers,         // integers stay integers
  reals,           // numbers; the result is a real
  integers,        // the result is one
  to_integer,      // numbers; the result is an integer
  equals,          // numbers, or booleans; the result is a boolean
  comparison,      // numbers; the result is a boolean
  booleans,        // or integers bit by bit
  reals_to_pose,   // numbers; the result is a pose
  poses,           // the result is a pose
  pose_or_joints,  // the result is a real
  reals_to_joints,
};

struct Row {
  Operator which;
  std::string_view name;
  Arity arity;
  Takes takes;
  ValueType gives = ValueType::real;  // where `takes` leaves it open
  bool looks = false;
};

constexpr std::uint8_t kMostJoints = static_cast<std::uint8_t>(kMaxJointsPerRobot);

constexpr std::array<Row, 43> kRows = {{
    {Operator::constant, "constant", {0, 0}, Takes::nothing},
    {Operator::variable, "variable", {0, 0}, Takes::nothing},
    {Operator::current_joints, "joints", {0, 0}, Takes::nothing, ValueType::joints, true},
    {Operator::current_position, "position", {0, 0}, Takes::nothing, ValueType::pose, true},
    {Operator::digital_input, "input", {1, 1}, Takes::one_integer, ValueType::boolean, true},
    {Operator::analogue_input, "analogue input", {1, 1}, Takes::one_integer, ValueType::real, true},
    {Operator::digital_output, "output", {1, 1}, Takes::one_integer, ValueType::boolean, true},
    {Operator::analogue_output, "analogue output", {1, 1}, Takes::one_integer, ValueType::real, true},
    {Operator::element, "element", {1, 1}, Takes::one_integer},
    {Operator::negate, "-", {1, 1}, Takes::numbers},
    {Operator::add, "+", {2, 2}, Takes::numbers},
    {Operator::subtract, "-", {2, 2}, Takes::numbers},
    {Operator::multiply, "*", {2, 2}, Takes::numbers},
    {Operator::divide, "/", {2, 2}, Takes::reals},
    {Operator::integer_divide, "div", {2, 2}, Takes::integers},
    {Operator::modulo, "mod", {2, 2}, Takes::integers},
    {Operator::power, "power", {2, 2}, Takes::reals},
    {Operator::absolute, "abs", {1, 1}, Takes::numbers},
    {Operator::square_root, "sqrt", {1, 1}, Takes::reals},
    {Operator::sine, "sin", {1, 1}, Takes::reals},
    {Operator::cosine, "cos", {1, 1}, Takes::reals},
    {Operator::tangent, "tan", {1, 1}, Takes::reals},
    {Operator::arc_sine, "asin", {1, 1}, Takes::reals},
    {Operator::arc_cosine, "acos", {1, 1}, Takes::reals},
    {Operator::arc_tangent, "atan2", {2, 2}, Takes::reals},
    {Operator::minimum, "min", {2, 2}, Takes::numbers},
    {Operator::maximum, "max", {2, 2}, Takes::numbers},
    {Operator::round, "round", {1, 1}, Takes::to_integer},
    {Operator::truncate, "truncate", {1, 1}, Takes::to_integer},
    {Operator::to_real, "real", {1, 1}, Takes::reals},
    {Operator::equal, "=", {2, 2}, Takes::equals},
    {Operator::not_equal, "<>", {2, 2}, Takes::equals},
    {Operator::less, "<", {2, 2}, Takes::comparison},
    {Operator::less_equal, "<=", {2, 2}, Takes::comparison},
    {Operator::greater, ">", {2, 2}, Takes::comparison},
    {Operator::greater_equal, ">=", {2, 2}, Takes::comparison},
    {Operator::logical_and, "and", {2, 2}, Takes::booleans},
    {Operator::logical_or, "or", {2, 2}, Takes::booleans},
    {Operator::logical_xor, "xor", {2, 2}, Takes::booleans},
    {Operator::logical_not, "not", {1, 1}, Takes::booleans},
    {Operator::make_pose, "pose", {6, 6}, Takes::reals_to_pose},
    {Operator::compose, "@", {2, 2}, Takes::poses},
    {Operator::inverse, "inv", {1, 1}, Takes::poses},
}};
// Behind the others, since their order is that of Operator.
constexpr Row kComponent = {Operator::component, "component", {1, 1}, Takes::pose_or_joints};
constexpr Row kMakeJoints = {Operator::make_joints, "joints", {1, kMostJoints}, Takes::reals_to_joints};

constexpr bool in_order() {
  for (std::size_t index = 0; index < kRows.size(); ++index) {
    if (static_cast<std::size_t>(kRows[index].which) != index) return false;
  }
  return true;
}
static_assert(in_order());

const Row& row_of(Operator which) {
  if (which == Operator::component) return kComponent;
  if (which == Operator::make_joints) return kMakeJoints;
  return kRows.at(static_cast<std::size_t>(which));
}

bool number(ValueType type) { return type == ValueType::integer || type == ValueType::real; }

bool all_of_type(std::span<const ValueType> operands, ValueType type) {
  return std::all_of(operands.begin(), operands.end(), [&](ValueType operand) { return operand == type; });
}

std::unexpected<Error> refuse(const Row& row, std::string_view what, std::span<const ValueType> operands) {
  std::string given;
  for (const ValueType operand : operands) {
    if (!given.empty()) given += " and ";
    given += name_of(operand);
  }
  return fail(fmt::format("'{}' takes {}, not {}", row.name, what, given));
}

}  // namespace

std::string_view name_of(Operator which) { return row_of(which).name; }
Arity arity_of(Operator which) { return row_of(which).arity; }
bool reads_world(Operator which) { return row_of(which).looks; }

Result<ValueType> result_type(Operator which, std::span<const ValueType> operands) {
  const Row& row = row_of(which);
  if (operands.size() < row.arity.least || operands.size() > row.arity.most) {
    return fail(fmt::format("'{}' takes {} operands, not {}", row.name,
                            row.arity.least == row.arity.most
                                ? fmt::format("{}", row.arity.least)
                                : fmt::format("{} to {}", row.arity.least, row.arity.most),
                            operands.size()));
  }
  const bool numbers = std::all_of(operands.begin(), operands.end(), number);
  const bool integers = all_of_type(operands, ValueType::integer);
  const bool booleans = all_of_type(operands, ValueType::boolean);
  const bool poses = all_of_type(operands, ValueType::pose);
  switch (row.takes) {
    case Takes::nothing:
      return row.gives;
    case Takes::one_integer:
      return integers ? Result<ValueType>(row.gives) : refuse(row, "a whole number", operands);
    case Takes::numbers:
      if (!numbers) return refuse(row, "numbers", operands);
      return integers ? ValueType::integer : ValueType::real;
    case Takes::reals:
      return numbers ? Result<ValueType>(ValueType::real) : refuse(row, "numbers", operands);
    case Takes::integers:
      return integers ? Result<ValueType>(ValueType::integer) : refuse(row, "integers", operands);
    case Takes::to_integer:
      return numbers ? Result<ValueType>(ValueType::integer) : refuse(row, "a number", operands);
    case Takes::equals:
      return numbers || booleans ? Result<ValueType>(ValueType::boolean)
                                 : refuse(row, "two numbers or two booleans", operands);
    case Takes::comparison:
      return numbers ? Result<ValueType>(ValueType::boolean) : refuse(row, "numbers", operands);
    case Takes::booleans:
      if (!booleans && !integers) return refuse(row, "booleans, or integers", operands);
      return integers ? ValueType::integer : ValueType::boolean;
    case Takes::reals_to_pose:
      return numbers ? Result<ValueType>(ValueType::pose) : refuse(row, "six numbers", operands);
    case Takes::poses:
      return poses ? Result<ValueType>(ValueType::pose) : refuse(row, "poses", operands);
    case Takes::pose_or_joints:
      return poses || all_of_type(operands, ValueType::joints) ? Result<ValueType>(ValueType::real)
                                                               : refuse(row, "a pose or joint values", operands);
    case Takes::reals_to_joints:
      return numbers ? Result<ValueType>(ValueType::joints) : refuse(row, "numbers", operands);
  }
  return row.gives;
}

}  // namespace cellmirror::program
