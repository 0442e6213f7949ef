#include "scripts/programs/irdata/terms.hpp"

#include <array>
#include <limits>

#include "rt_core/base/contract.hpp"

namespace cellmirror::program::irdata {

Term integer_literal(std::int64_t value, std::uint32_t column) {
  Term term;
  term.known = true;
  term.literal = true;
  term.type = ValueType::integer;
  term.integer = value;
  term.column = column;
  return term;
}

Term real_literal(double value, std::uint32_t column) {
  Term term;
  term.known = true;
  term.literal = true;
  term.real = value;
  term.column = column;
  return term;
}

std::string_view with_article(ValueType type) {
  switch (type) {
    case ValueType::boolean:
      return "a boolean";
    case ValueType::integer:
      return "an integer";
    case ValueType::real:
      return "a real";
    case ValueType::pose:
      return "a pose";
    case ValueType::joints:
      break;
  }
  return "joint values";
}

Term Terms::apply(Operator which, std::uint32_t column, std::span<const Term> operands, std::uint32_t payload) {
  CELLMIRROR_EXPECTS(operands.size() <= kMaxJointsPerRobot);
  Term term;
  term.column = column;
  std::array<ExpressionId, kMaxJointsPerRobot> ids{};
  for (const Term& operand : operands)
    if (!operand.known) return term;
  for (std::size_t i = 0; i < operands.size(); ++i) ids[i] = id(operands[i]);
  const auto made = builder_.operation(which, std::span(ids).first(operands.size()), payload);
  if (!made) {
    findings_.error(column, made.error().what, made.error().remedy);
    return term;
  }
  term.known = true;
  term.id = *made;
  term.type = builder_.type(*made);
  return term;
}

Term Terms::value(const Value& value, std::uint32_t column) {
  Term term;
  term.known = true;
  term.column = column;
  term.type = type_of(value);
  term.id = builder_.constant(value);
  return term;
}

Term Terms::variable(VariableId id, std::uint32_t column) {
  Term term;
  term.column = column;
  if (id == kNone) return term;  // there were too many, which has been reported
  const auto made = builder_.variable(id);
  if (!made) {
    findings_.error(column, made.error().what, made.error().remedy);
    return term;
  }
  term.known = true;
  term.id = *made;
  term.type = builder_.type(*made);
  return term;
}

Term Terms::negated(const Term& term) {
  // The least integer has no negative; the operation reports that.
  if (!term.literal || term.integer == std::numeric_limits<std::int64_t>::min())
    return apply(Operator::negate, term.column, {term});
  Term out = term;
  out.integer = -term.integer;
  out.real = -term.real;
  return out;
}

Term Terms::as_real(const Term& number) {
  if (!number.known || number.type == ValueType::real) return number;
  if (number.literal) return real_literal(number.number(), number.column);
  return apply(Operator::to_real, number.column, {number});
}

Term Terms::scaled(const Term& number, double factor) {
  if (!number.known) return number;
  if (number.literal) return real_literal(number.number() * factor, number.column);
  return apply(Operator::multiply, number.column, {number, real_literal(factor, number.column)});
}

ExpressionId Terms::id(const Term& term) {
  CELLMIRROR_EXPECTS(term.known);
  if (!term.literal) return term.id;
  return term.type == ValueType::integer ? builder_.integer(term.integer) : builder_.real(term.real);
}

std::optional<Value> Terms::constant(const Term& term) const {
  if (!term.known) return std::nullopt;
  if (term.literal) {
    if (term.type == ValueType::integer) return Value(term.integer);
    return Value(term.real);
  }
  const Value* value = builder_.constant_value(term.id);
  if (value == nullptr) return std::nullopt;
  return *value;
}

std::optional<double> Terms::constant_number(const Term& term) const {
  if (!term.known || !term.is_number()) return std::nullopt;
  if (term.literal) return term.number();
  return builder_.constant_number(term.id);
}

}  // namespace cellmirror::program::irdata
