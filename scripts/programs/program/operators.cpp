// What operators do to values: expression.hpp's apply().
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <string>

#include "scripts/programs/program/expression.hpp"

namespace cellmirror::program {
namespace {

using Integer = std::int64_t;

std::optional<double> as_real(const Value& value) {
  if (const auto* real = std::get_if<double>(&value)) return *real;
  if (const auto* integer = std::get_if<Integer>(&value)) return static_cast<double>(*integer);
  return std::nullopt;
}

std::unexpected<Error> wrong_types(Operator which) {
  return fail(fmt::format("'{}' does not take such values", name_of(which)));
}

Result<Value> finite(Operator which, double value) {
  if (!std::isfinite(value)) return fail(fmt::format("the result of '{}' is not a finite number", name_of(which)));
  return value;
}

std::unexpected<Error> overflow(Operator which) {
  return fail(fmt::format("the result of '{}' exceeds the range of an integer", name_of(which)));
}

Result<Value> apply_to_integer(Operator which, Integer a) {
  constexpr Integer kLeast = std::numeric_limits<Integer>::min();
  if (which == Operator::logical_not) return ~a;
  if (which == Operator::negate || (which == Operator::absolute && a < 0)) {
    if (a == kLeast) return overflow(which);
    return -a;
  }
  return a;  // absolute, round, truncate
}

Result<Value> apply_to_integers(Operator which, Integer a, Integer b) {
  Integer result = 0;
  bool overflows = false;
  switch (which) {
    case Operator::add:
      overflows = __builtin_add_overflow(a, b, &result);
      break;
    case Operator::subtract:
      overflows = __builtin_sub_overflow(a, b, &result);
      break;
    case Operator::multiply:
      overflows = __builtin_mul_overflow(a, b, &result);
      break;
    case Operator::integer_divide:
    case Operator::modulo:
      if (b == 0) return fail("division by 0");
      if (b == -1) {  // the least integer divided by -1 does not fit; its remainder is 0 all the same
        if (which == Operator::modulo) return Integer{0};
        overflows = __builtin_sub_overflow(Integer{0}, a, &result);
        break;
      }
      result = which == Operator::modulo ? a % b : a / b;
      break;
    case Operator::minimum:
      result = std::min(a, b);
      break;
    case Operator::maximum:
      result = std::max(a, b);
      break;
    case Operator::logical_and:
      result = a & b;
      break;
    case Operator::logical_or:
      result = a | b;
      break;
    case Operator::logical_xor:
      result = a ^ b;
      break;
    default:
      return wrong_types(which);
  }
  if (overflows) return overflow(which);
  return result;
}

Result<Value> to_integer(Operator which, double value) {
  const double whole = which == Operator::round ? std::round(value) : std::trunc(value);
  constexpr double kTooLarge = 9223372036854775808.0;  // 2^63
  if (!(whole >= -kTooLarge && whole < kTooLarge)) return overflow(which);
  return static_cast<Integer>(whole);
}

Result<Value> apply_to_real(Operator which, double a) {
  switch (which) {
    case Operator::negate:
      return -a;
    case Operator::absolute:
      return std::abs(a);
    case Operator::square_root:
      if (a < 0) return fail("the square root of a number below 0");
      return std::sqrt(a);
    case Operator::sine:
      return finite(which, std::sin(a));
    case Operator::cosine:
      return finite(which, std::cos(a));
    case Operator::tangent:
      return finite(which, std::tan(a));
    case Operator::arc_sine:
    case Operator::arc_cosine:
      if (std::abs(a) > 1) return fail(fmt::format("'{}' of a number beyond -1 .. 1", name_of(which)));
      return which == Operator::arc_sine ? std::asin(a) : std::acos(a);
    case Operator::round:
    case Operator::truncate:
      return to_integer(which, a);
    case Operator::to_real:
      return finite(which, a);
    default:
      return wrong_types(which);
  }
}

Result<Value> apply_to_reals(Operator which, double a, double b) {
  switch (which) {
    case Operator::add:
      return finite(which, a + b);
    case Operator::subtract:
      return finite(which, a - b);
    case Operator::multiply:
      return finite(which, a * b);
    case Operator::divide:
      if (b == 0) return fail("division by 0");
      return finite(which, a / b);
    case Operator::power:
      return finite(which, std::pow(a, b));
    case Operator::arc_tangent:
      return finite(which, std::atan2(a, b));
    case Operator::minimum:
      return finite(which, std::min(a, b));
    case Operator::maximum:
      return finite(which, std::max(a, b));
    default:
      return wrong_types(which);
  }
}

bool is_comparison(Operator which) { return which >= Operator::equal && which <= Operator::greater_equal; }

template <class T>
Result<Value> compare(Operator which, T a, T b) {
  switch (which) {
    case Operator::equal:
      return a == b;
    case Operator::not_equal:
      return a != b;
    case Operator::less:
      return a < b;
    case Operator::less_equal:
      return a <= b;
    case Operator::greater:
      return a > b;
    case Operator::greater_equal:
      return a >= b;
    default:
      return wrong_types(which);
  }
}

Result<Value> apply_to_booleans(Operator which, bool a, bool b) {
  switch (which) {
    case Operator::equal:
      return a == b;
    case Operator::not_equal:
    case Operator::logical_xor:
      return a != b;
    case Operator::logical_and:
      return a && b;
    case Operator::logical_or:
      return a || b;
    default:
      return wrong_types(which);
  }
}

Result<Value> make_pose(std::span<const Value> operands) {
  std::array<double, 6> numbers{};
  if (operands.size() != numbers.size()) return wrong_types(Operator::make_pose);
  for (std::size_t index = 0; index < numbers.size(); ++index) {
    const auto number = as_real(operands[index]);
    if (!number || !std::isfinite(*number)) return wrong_types(Operator::make_pose);
    numbers[index] = *number;
  }
  return pose_from_xyz_rpy({numbers[0], numbers[1], numbers[2]}, {numbers[3], numbers[4], numbers[5]});
}

Result<Value> make_joints(std::span<const Value> operands, std::uint32_t payload) {
  JointPosition position;
  position.units = joint_units(payload);
  if (operands.size() > position.values.size()) return wrong_types(Operator::make_joints);
  for (const Value& operand : operands) {
    const auto number = as_real(operand);
    if (!number || !std::isfinite(*number)) return wrong_types(Operator::make_joints);
    position.values[position.count++] = *number;
  }
  return position;
}

Result<Value> component(const Value& value, std::uint32_t which) {
  if (const auto* joints = std::get_if<JointPosition>(&value)) {
    if (which >= joints->count) return fail(fmt::format("joint {} of {} joint values", which + 1, joints->count));
    return joints->values[which];
  }
  const auto* X = std::get_if<Pose>(&value);
  if (X == nullptr || which >= 6) return wrong_types(Operator::component);
  if (which < 3) return X->translation()[which];
  return rpy_from_rotation(X->linear())[which - 3];
}

Result<Value> apply_to_poses(Operator which, std::span<const Value> operands) {
  const auto* X_AB = std::get_if<Pose>(&operands[0]);
  if (X_AB == nullptr) return wrong_types(which);
  Pose X = X_AB->inverse();
  if (which == Operator::compose) {
    const auto* X_BC = std::get_if<Pose>(&operands[1]);
    if (X_BC == nullptr) return wrong_types(which);
    X = *X_AB * *X_BC;
  }
  if (!X.matrix().allFinite()) return fail(fmt::format("the result of '{}' is not finite", name_of(which)));
  return X;
}

Result<Value> apply_one(Operator which, const Value& a) {
  if (const auto* boolean = std::get_if<bool>(&a)) {
    if (which == Operator::logical_not) return !*boolean;
    return wrong_types(which);
  }
  const auto* integer = std::get_if<Integer>(&a);
  const bool stays_integer = which == Operator::negate || which == Operator::absolute || which == Operator::round ||
                             which == Operator::truncate || which == Operator::logical_not;
  if (integer != nullptr && stays_integer) return apply_to_integer(which, *integer);
  const auto real = as_real(a);
  return real ? apply_to_real(which, *real) : wrong_types(which);
}

Result<Value> apply_two(Operator which, const Value& a, const Value& b) {
  const auto* boolean_a = std::get_if<bool>(&a);
  const auto* boolean_b = std::get_if<bool>(&b);
  if (boolean_a != nullptr && boolean_b != nullptr) return apply_to_booleans(which, *boolean_a, *boolean_b);
  const auto* integer_a = std::get_if<Integer>(&a);
  const auto* integer_b = std::get_if<Integer>(&b);
  const bool makes_real = which == Operator::divide || which == Operator::power || which == Operator::arc_tangent;
  if (integer_a != nullptr && integer_b != nullptr && !makes_real) {
    return is_comparison(which) ? compare(which, *integer_a, *integer_b)
                                : apply_to_integers(which, *integer_a, *integer_b);
  }
  const auto real_a = as_real(a);
  const auto real_b = as_real(b);
  if (!real_a || !real_b) return wrong_types(which);
  return is_comparison(which) ? compare(which, *real_a, *real_b) : apply_to_reals(which, *real_a, *real_b);
}

}  // namespace

Result<Value> apply(Operator which, std::span<const Value> operands, std::uint32_t payload) {
  const Arity arity = arity_of(which);
  if (operands.empty() || operands.size() < arity.least || operands.size() > arity.most) return wrong_types(which);
  switch (which) {
    case Operator::make_pose:
      return make_pose(operands);
    case Operator::make_joints:
      return make_joints(operands, payload);
    case Operator::component:
      return component(operands[0], payload);
    case Operator::compose:
    case Operator::inverse:
      return apply_to_poses(which, operands);
    default:
      return operands.size() == 1 ? apply_one(which, operands[0]) : apply_two(which, operands[0], operands[1]);
  }
}

}  // namespace cellmirror::program
