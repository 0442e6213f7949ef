// Records that compute: a result, then what it is made of.
#include <fmt/format.h>

#include <array>

#include "rt_core/base/units.hpp"
#include "scripts/programs/irdata/translator.hpp"

namespace cellmirror::program::irdata {

namespace {

Operator operator_of(Operation operation) {
  switch (operation) {
    case Operation::add:
      return Operator::add;
    case Operation::sub:
      return Operator::subtract;
    case Operation::mul:
      return Operator::multiply;
    case Operation::div:
      return Operator::divide;
    case Operation::idiv:
      return Operator::integer_divide;
    case Operation::mod:
      return Operator::modulo;
    case Operation::pow:
      return Operator::power;
    case Operation::min:
      return Operator::minimum;
    case Operation::max:
      return Operator::maximum;
    case Operation::atan2:
      return Operator::arc_tangent;
    case Operation::logical_and:
      return Operator::logical_and;
    case Operation::logical_or:
      return Operator::logical_or;
    case Operation::logical_xor:
      return Operator::logical_xor;
    case Operation::compose:
      return Operator::compose;
    case Operation::neg:
      return Operator::negate;
    case Operation::abs:
      return Operator::absolute;
    case Operation::sqrt:
      return Operator::square_root;
    case Operation::sin:
      return Operator::sine;
    case Operation::cos:
      return Operator::cosine;
    case Operation::tan:
      return Operator::tangent;
    case Operation::asin:
      return Operator::arc_sine;
    case Operation::acos:
      return Operator::arc_cosine;
    case Operation::round:
      return Operator::round;
    case Operation::trunc:
      return Operator::truncate;
    case Operation::logical_not:
      return Operator::logical_not;
    default:
      return Operator::inverse;
  }
}

bool takes_two(Operation operation) { return operation >= Operation::add && operation <= Operation::compose; }
bool takes_degrees(Operation operation) {
  return operation == Operation::sin || operation == Operation::cos || operation == Operation::tan;
}
bool gives_degrees(Operation operation) {
  return operation == Operation::asin || operation == Operation::acos || operation == Operation::atan2;
}

}  // namespace

void Translator::arithmetic_record() {
  switch (operation_) {
    case Operation::inc:
    case Operation::dec:
      return step_record();
    case Operation::shift:
      return shift_record();
    default:
      break;
  }
  const AssignTarget target = target_parameter();
  Term value;
  switch (operation_) {
    case Operation::set:
      value = value_parameter();
      break;
    case Operation::get_pose:
      value = terms_.apply(Operator::current_position, target.column, {});
      break;
    case Operation::get_joints:
      value =
          terms_.apply(Operator::current_joints, target.column, {}, static_cast<std::uint32_t>(JointUnits::degree_mm));
      break;
    default:
      value = operation_result();
      break;
  }
  assign(target, value);
}

Term Translator::operation_result() {
  const Operator which = operator_of(operation_);
  Term a = value_parameter();
  if (takes_degrees(operation_)) {
    a = checked(a, "an angle", ValueType::real);
    a = terms_.scaled(a, kRadPerDeg);
  }
  if (!takes_two(operation_)) {
    Term result = terms_.apply(which, operation_column_, {a});
    return gives_degrees(operation_) ? terms_.scaled(result, 1.0 / kRadPerDeg) : result;
  }
  const Term b = value_parameter();
  const Term result = terms_.apply(which, operation_column_, {a, b});
  return gives_degrees(operation_) ? terms_.scaled(result, 1.0 / kRadPerDeg) : result;
}

// An integer becomes a real where one is wanted, millimetres and degrees become SI in components of poses.
void Translator::assign(const AssignTarget& target, const Term& value) {
  if (!target.known || !value.known) return;
  if (value.type != target.type && !(target.type == ValueType::real && value.type == ValueType::integer)) {
    findings_.error(target.column,
                    fmt::format("this takes {}, the value is {}", with_article(target.type), with_article(value.type)),
                    target.type == ValueType::integer && value.type == ValueType::real
                        ? "use ROUND or TRUNC"
                        : "declare the variable with the type of the value");
    return;
  }
  Term written = target.type == ValueType::real ? terms_.as_real(value) : value;
  if (target.si_per_written != 1) written = terms_.scaled(written, target.si_per_written);
  if (!written.known) return;
  AssignStatement statement;
  statement.variable = target.variable;
  statement.index = target.index;
  statement.component = target.component;
  statement.value = terms_.id(written);
  add(statement, target.column);
}

// INC and DEC: the variable is read as what is assigned to, and once more as a value.
void Translator::step_record() {
  const AssignTarget target = target_parameter();
  if (!target.known) {
    if (!incomplete_ && next_parameter()) cursor_.go_to(cursor_.line().size());
    return;
  }
  Cursor again(cursor_.line());
  again.go_to(target.column - 1);
  const Term old = reader_.read(again);
  Term by = integer_literal(1, target.column);
  cursor_.skip_blank();
  if (!cursor_.at_end()) by = value_parameter();
  if (!old.known || !by.known) return;
  assign(target, terms_.apply(operation_ == Operation::inc ? Operator::add : Operator::subtract, by.column, {old, by}));
}

// Along the axes of the frame that the pose is given in.
void Translator::shift_record() {
  const AssignTarget target = target_parameter();
  std::array<Term, 6> offset;
  for (std::size_t i = 0; i < 3; ++i)
    offset[i] = terms_.scaled(typed_parameter("a shift in mm", ValueType::real), kMPerMm);
  for (std::size_t i = 3; i < 6; ++i) offset[i] = real_literal(0, operation_column_);
  if (!target.known) return;
  if (target.type != ValueType::pose) {
    findings_.error(target.column, fmt::format("SHIFT moves poses, this is {}", with_article(target.type)),
                    "write the name of a pose variable");
    return;
  }
  Cursor again(cursor_.line());
  again.go_to(target.column - 1);
  const Term old = reader_.read(again);
  assign(target, terms_.apply(Operator::compose, operation_column_,
                              {terms_.apply(Operator::make_pose, operation_column_, offset), old}));
}

VariableId Translator::hidden_variable(ValueType type) {
  // No name of a text begins with '#'.
  const auto variable = builder_.declare(fmt::format("#{}", ++hidden_), type);
  if (variable) return *variable;
  refuse(operation_column_, variable.error());
  return kNone;
}

void Translator::assign_hidden(VariableId variable, const Term& value) {
  if (variable == kNone || !value.known) return;
  AssignStatement statement;
  statement.variable = variable;
  statement.value = terms_.id(value);
  add(statement, operation_column_);
}

}  // namespace cellmirror::program::irdata
