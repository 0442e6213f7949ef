#include "scripts/programs/srcl/emitter.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "rt_core/base/contract.hpp"
#include "scripts/programs/srcl/keywords.hpp"

namespace cellmirror::program::srcl {

Operand Operand::of(std::int64_t value) {
  Operand operand;
  operand.form = Form::integer;
  operand.type = ValueType::integer;
  operand.integer = value;
  return operand;
}

Operand Operand::of(double value) {
  Operand operand;
  operand.form = Form::real;
  operand.real = value;
  return operand;
}

Operand Operand::of(bool value) {
  Operand operand;
  operand.form = Form::boolean;
  operand.type = ValueType::boolean;
  operand.truth = value;
  return operand;
}

std::string_view word_of(ValueType type) {
  switch (type) {
    case ValueType::boolean:
      return spelling(Keyword::boolean);
    case ValueType::integer:
      return spelling(Keyword::integer);
    case ValueType::real:
      return spelling(Keyword::real);
    case ValueType::pose:
      return spelling(Keyword::pose);
    case ValueType::joints:
      return spelling(Keyword::joints);
  }
  return {};
}

StatementId Emitter::add(Statement statement, std::uint32_t line, std::uint32_t column) {
  constexpr std::uint32_t kLastColumn = 0xFFFF;
  StatementPlace place;
  place.line = line;
  place.column = static_cast<std::uint16_t>(std::min(column, kLastColumn));
  if (!label_.empty()) {
    place.label = text(label_);
    label_.clear();
  }
  program_.statements.push_back(statement);
  program_.places.push_back(place);
  return here() - 1;
}

void Emitter::set_target(StatementId statement, StatementId target) {
  Statement& written = program_.statements[statement];
  if (auto* const jump = std::get_if<JumpStatement>(&written)) {
    jump->target = target;
  } else if (auto* const branch = std::get_if<BranchStatement>(&written)) {
    branch->target = target;
  } else {
    auto* const call = std::get_if<CallStatement>(&written);
    CELLMIRROR_EXPECTS(call != nullptr);
    call->target = target;
  }
}

ExpressionId Emitter::constant(Value value) {
  program_.constants.push_back(std::move(value));
  ExpressionNode node;
  node.payload = static_cast<std::uint32_t>(program_.constants.size() - 1);
  program_.expressions.push_back(node);
  return static_cast<ExpressionId>(program_.expressions.size() - 1);
}

ExpressionId Emitter::expression(const Operand& operand) {
  switch (operand.form) {
    case Operand::Form::integer:
      return constant(operand.integer);
    case Operand::Form::real:
      return constant(operand.real);
    case Operand::Form::boolean:
      return constant(operand.truth);
    case Operand::Form::stored: {
      ExpressionNode node;
      node.payload = operand.index;
      program_.expressions.push_back(node);
      return static_cast<ExpressionId>(program_.expressions.size() - 1);
    }
    case Operand::Form::node:
      return operand.index;
    case Operand::Form::unknown:
      break;
  }
  CELLMIRROR_EXPECTS(operand.known());
  return kNoExpression;
}

Operand Emitter::node(Operator which, ValueType type, std::span<const Operand> operands, std::uint32_t payload) {
  Operand result;
  result.form = Operand::Form::node;
  result.type = type;
  result.depth = 1;
  std::array<ExpressionId, kMaxJointsPerRobot> ids{};
  CELLMIRROR_EXPECTS(operands.size() <= ids.size());
  for (std::size_t i = 0; i < operands.size(); ++i) {
    ids[i] = expression(operands[i]);
    result.depth = std::max(result.depth, static_cast<std::uint8_t>(operands[i].depth + 1));
  }
  ExpressionNode node;
  node.which = which;
  node.operands = static_cast<std::uint8_t>(operands.size());
  node.first_operand = static_cast<std::uint32_t>(program_.operands.size());
  node.payload = payload;
  program_.operands.insert(program_.operands.end(), ids.begin(),
                           ids.begin() + static_cast<std::ptrdiff_t>(operands.size()));
  program_.expressions.push_back(node);
  result.index = static_cast<std::uint32_t>(program_.expressions.size() - 1);
  return result;
}

Value Emitter::value_of(const Operand& constant) const {
  switch (constant.form) {
    case Operand::Form::integer:
      return constant.integer;
    case Operand::Form::real:
      return constant.real;
    case Operand::Form::boolean:
      return constant.truth;
    default:
      CELLMIRROR_EXPECTS(constant.form == Operand::Form::stored);
      return program_.constants[constant.index];
  }
}

Result<Operand> Emitter::computed(Operator which, std::span<const Operand> operands, std::uint32_t payload) {
  std::array<Value, kMaxJointsPerRobot> values;
  CELLMIRROR_EXPECTS(operands.size() <= values.size());
  for (std::size_t i = 0; i < operands.size(); ++i) values[i] = value_of(operands[i]);
  Result<Value> result = apply(which, std::span(values).first(operands.size()), payload);
  if (!result) return std::unexpected(std::move(result).error());
  if (const auto* const truth = std::get_if<bool>(&*result)) return Operand::of(*truth);
  if (const auto* const integer = std::get_if<std::int64_t>(&*result)) return Operand::of(*integer);
  if (const auto* const real = std::get_if<double>(&*result)) return Operand::of(*real);
  return stored(std::move(*result));
}

Operand Emitter::stored(Value value) {
  Operand operand;
  operand.form = Operand::Form::stored;
  operand.type = type_of(value);
  program_.constants.push_back(std::move(value));
  operand.index = static_cast<std::uint32_t>(program_.constants.size() - 1);
  return operand;
}

Operand Emitter::real(const Operand& number, double factor) {
  if (!number.known()) return number;
  if (number.constant()) return Operand::of(number.value() * factor);
  if (factor != 1) return node(Operator::multiply, ValueType::real, {number, Operand::of(factor)});
  return number.type == ValueType::real ? number : node(Operator::to_real, ValueType::real, {number});
}

TextId Emitter::text(std::string_view text) {
  program_.texts.emplace_back(text);
  return static_cast<TextId>(program_.texts.size() - 1);
}

VariableId Emitter::add_variable(std::string name, ValueType type) {
  Variable variable;
  variable.name = std::move(name);
  variable.type = type;
  switch (type) {
    case ValueType::boolean:
      variable.initial.emplace_back(false);
      break;
    case ValueType::integer:
      variable.initial.emplace_back(std::int64_t{0});
      break;
    case ValueType::real:
      variable.initial.emplace_back(0.0);
      break;
    case ValueType::pose:
      variable.initial.emplace_back(Pose::Identity());
      break;
    case ValueType::joints:
      variable.initial.emplace_back(JointPosition{});
      break;
  }
  program_.variables.push_back(std::move(variable));
  return static_cast<VariableId>(program_.variables.size() - 1);
}

}  // namespace cellmirror::program::srcl
