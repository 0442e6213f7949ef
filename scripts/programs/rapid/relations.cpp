// Conditions: comparisons, AND, OR, XOR, NOT, and signals.
#include <fmt/format.h>

#include <utility>

#include "scripts/programs/rapid/expressions.hpp"

namespace cellmirror::program::rapid {

std::optional<Operand> ExpressionReader::whole() {
  std::optional<Operand> left = conjunction();
  while (left && (lexer_.at("OR") || lexer_.at("XOR"))) {
    const Token at = lexer_.token();
    lexer_.advance();
    const std::optional<Operand> right = conjunction();
    if (!right) return std::nullopt;
    left = logic(at.is("OR") ? Operator::logical_or : Operator::logical_xor, *left, *right, at);
  }
  return left;
}

// NOT is the weakest operator of RAPID, while people read it as the strongest: where the two differ, brackets are asked
// for.
std::optional<Operand> ExpressionReader::conjunction() {
  bool negated = false;
  std::optional<Operand> left = relation(negated);
  while (left && lexer_.at("AND")) {
    const Token at = lexer_.token();
    if (std::exchange(negated, false)) {
      error(at, "it is not clear what NOT before this AND negates", "write (NOT a) AND b, or NOT (a AND b)");
    }
    lexer_.advance();
    bool later = false;
    const std::optional<Operand> right = relation(later);
    if (!right) return std::nullopt;
    left = logic(Operator::logical_and, *left, *right, at);
  }
  return left;
}

std::optional<Operand> ExpressionReader::relation(bool& negated) {
  if (!lexer_.at("NOT")) return comparison();
  const Token at = lexer_.token();
  lexer_.advance();
  negated = true;
  const std::optional<Operand> operand = comparison();
  if (!operand || !operand->known()) return operand;
  if (operand->type != Type::boolean) return wrong_type(at, "NOT", "a condition", *operand);
  return combine(Operator::logical_not, Type::boolean, {operand->id}, at);
}

namespace {

std::optional<Operator> relation_operator(Sign sign) {
  switch (sign) {
    case Sign::equal:
      return Operator::equal;
    case Sign::not_equal:
      return Operator::not_equal;
    case Sign::less:
      return Operator::less;
    case Sign::less_equal:
      return Operator::less_equal;
    case Sign::greater:
      return Operator::greater;
    case Sign::greater_equal:
      return Operator::greater_equal;
    default:
      return std::nullopt;
  }
}

bool is_signal(const Operand& operand) { return operand.type == Type::signal_in || operand.type == Type::signal_out; }

}  // namespace

std::optional<Operand> ExpressionReader::comparison() {
  std::optional<Operand> left = sum();
  if (!left) return left;
  const Token at = lexer_.token();
  const std::optional<Operator> which = relation_operator(at.sign);
  if (!which) return left;
  lexer_.advance();
  const std::optional<Operand> right = sum();
  if (!right) return std::nullopt;
  return compare(*which, *left, *right, at);
}

Operand ExpressionReader::logic(Operator which, const Operand& left, const Operand& right, const Token& at) {
  if (!left.known() || !right.known()) return Operand{};
  if (left.type != Type::boolean) return wrong_type(at, shown(at), "two conditions", left);
  if (right.type != Type::boolean) return wrong_type(at, shown(at), "two conditions", right);
  return combine(which, Type::boolean, {left.id, right.id}, at);
}

Operand ExpressionReader::compare(Operator which, const Operand& left, const Operand& right, const Token& at) {
  if (!left.known() || !right.known()) return Operand{};
  const bool equality = which == Operator::equal || which == Operator::not_equal;
  if (is_signal(left) || is_signal(right)) {
    if (equality)
      return is_signal(left) ? compare_signal(which, left, right, at) : compare_signal(which, right, left, at);
    error(at, fmt::format("a signal is not compared by {}", shown(at)), "write = 1 or = 0");
    return Operand{};
  }
  const bool booleans = equality && left.type == Type::boolean && right.type == Type::boolean;
  const bool numbers = left.type == Type::num && right.type == Type::num;
  if (booleans || numbers) return combine(which, Type::boolean, {left.id, right.id}, at);
  return wrong_type(at, shown(at), equality ? "two numbers, or two conditions" : "two numbers",
                    left.type == Type::num ? right : left);
}

// di1 = 1: the port itself; with 0, or by <>, the opposite of it.
Operand ExpressionReader::compare_signal(Operator which, const Operand& left, const Operand& right, const Token& at) {
  const Value* const level = right.type == Type::num ? builder_.constant_value(right.id) : nullptr;
  const double* const number = level == nullptr ? nullptr : std::get_if<double>(level);
  if (number == nullptr || (*number != 0 && *number != 1)) {
    error(at, "a signal is compared with 0 or 1 only", "write = 1 or = 0, also as high and low");
    return Operand{};
  }
  const bool on = (*number == 1) == (which == Operator::equal);
  const Operator reads = left.type == Type::signal_in ? Operator::digital_input : Operator::digital_output;
  const Operand port = combine(reads, Type::boolean, {builder_.integer(left.port)}, at);
  return on || !port.known() ? port : combine(Operator::logical_not, Type::boolean, {port.id}, at);
}

// TestDI(di1); the bracket has been read.
std::optional<Operand> ExpressionReader::test_signal(bool output) {
  const Token at = lexer_.token();
  const std::optional<Operand> signal = read_signal(output);
  if (!signal || !expect(Sign::close, ")")) return std::nullopt;
  if (!signal->known()) return signal;
  return combine(Operator::digital_input, Type::boolean, {builder_.integer(signal->port)}, at);
}

std::optional<Operand> ExpressionReader::read_signal(bool output) {
  const Token name = lexer_.token();
  if (name.kind != TokenKind::word) {
    error(name, fmt::format("the name of a signal is missing before {}", shown(name)),
          fmt::format("write {}, the port with this number", output ? "do1" : "di1"));
    return std::nullopt;
  }
  lexer_.advance();
  const std::optional<SignalName> signal = signal_of(name.text);
  if (signal && signal->output == output) {
    return Operand{output ? Type::signal_out : Type::signal_in, kNoExpression, signal->number};
  }
  error(name, fmt::format("{} is not a digital {}", shown(name), output ? "output" : "input"),
        fmt::format("name it after its port: {0}1 .. {0}{1}", output ? "do" : "di", kMostPorts));
  return Operand{};
}

std::optional<bool> ExpressionReader::read_level() {
  const Token at = lexer_.token();
  bool known = true;
  const std::optional<Value> value = read_constant(Type::num, "the level of a signal", known);
  if (!value) return std::nullopt;
  if (!known) return true;
  const double level = std::get<double>(*value);
  if (level != 0 && level != 1) error(at, fmt::format("a digital signal cannot be {}", level), "write 0 or 1");
  return level != 0;
}

}  // namespace cellmirror::program::rapid
