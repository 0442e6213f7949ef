#include "scripts/programs/irdata/expression_reader.hpp"

#include <fmt/format.h>

#include <charconv>
#include <cmath>

#include "rt_core/base/text.hpp"
#include "rt_core/base/units.hpp"

namespace cellmirror::program::irdata {

Term ExpressionReader::read(Cursor& cursor) {
  cursor_ = &cursor;
  failed_ = false;
  depth_ = 0;
  arguments_.clear();
  return value();
}

// Most values are a number alone: those need no operator parsing.
Term ExpressionReader::value() {
  cursor_->skip_blank();
  const std::size_t begin = cursor_->at();
  const std::uint32_t column = cursor_->column();
  const bool negative = cursor_->peek() == '-';
  if (negative) cursor_->skip();
  if (is_digit(cursor_->peek())) {
    Term term = number();
    if (failed_) return term;
    cursor_->skip_blank();
    const char next = cursor_->peek();
    if (next == ',' || next == ')' || cursor_->at_end()) {
      if (negative) term = terms_.negated(term);
      term.column = column;
      return term;
    }
  }
  cursor_->go_to(begin);
  return binary(1);
}

Term ExpressionReader::syntax_error(std::uint32_t column, std::string message, std::string remedy) {
  if (!failed_) terms_.findings().error(column, std::move(message), std::move(remedy));
  failed_ = true;
  Term term;
  term.column = column;
  return term;
}

// Precedence climbing: reads operands and all operators that bind at least as strongly as `lowest`.
Term ExpressionReader::binary(int lowest) {
  Term left = unary();
  while (!failed_) {
    cursor_->skip_blank();
    const std::optional<BinaryOperator> with = peek_operator();
    if (!with || with->precedence < lowest) break;
    const std::uint32_t column = cursor_->column();
    cursor_->go_to(cursor_->at() + with->length);
    cursor_->skip_blank();
    const Term right = binary(with->precedence + 1);
    if (failed_) return right;
    left = combine(*with, column, left, right);
  }
  return left;
}

Term ExpressionReader::combine(const BinaryOperator& with, std::uint32_t column, const Term& left, const Term& right) {
  Term term = terms_.apply(with.which, column, {left, right});
  term.column = left.column;
  return term;
}

std::optional<ExpressionReader::BinaryOperator> ExpressionReader::peek_operator() {
  switch (cursor_->peek()) {
    case '+':
      return BinaryOperator{Operator::add, 5, 1};
    case '-':
      return BinaryOperator{Operator::subtract, 5, 1};
    case '*':
      return BinaryOperator{Operator::multiply, 6, 1};
    case '/':
      return BinaryOperator{Operator::divide, 6, 1};
    case '@':
      return BinaryOperator{Operator::compose, 6, 1};
    case '=':
      return BinaryOperator{Operator::equal, 4, 1};
    case '<':
      if (cursor_->peek_behind() == '>') return BinaryOperator{Operator::not_equal, 4, 2};
      if (cursor_->peek_behind() == '=') return BinaryOperator{Operator::less_equal, 4, 2};
      return BinaryOperator{Operator::less, 4, 1};
    case '>':
      if (cursor_->peek_behind() == '=') return BinaryOperator{Operator::greater_equal, 4, 2};
      return BinaryOperator{Operator::greater, 4, 1};
    default:
      break;
  }
  if (!is_letter(cursor_->peek())) return std::nullopt;
  const std::size_t begin = cursor_->at();
  const std::string_view text = cursor_->name();
  cursor_->go_to(begin);
  const std::optional<Word> word = find_word(text);
  if (word == Word::logical_or) return BinaryOperator{Operator::logical_or, 1, text.size()};
  if (word == Word::logical_xor) return BinaryOperator{Operator::logical_xor, 1, text.size()};
  if (word == Word::logical_and) return BinaryOperator{Operator::logical_and, 2, text.size()};
  if (word == Word::div) return BinaryOperator{Operator::integer_divide, 6, text.size()};
  if (word == Word::mod) return BinaryOperator{Operator::modulo, 6, text.size()};
  return std::nullopt;
}

Term ExpressionReader::unary() {
  if (++depth_ > kDeepest)
    return syntax_error(cursor_->column(), "the expression is nested too deep", "divide it into several records");
  Term term;
  cursor_->skip_blank();
  const std::uint32_t column = cursor_->column();
  const std::size_t begin = cursor_->at();
  if (cursor_->take('-')) {
    term = unary();
    if (term.known) term = terms_.negated(term);
    term.column = column;
  } else if (cursor_->take('+')) {
    term = unary();
  } else if (is_letter(cursor_->peek()) && find_word(cursor_->name()) == Word::logical_not) {
    const Term operand = binary(4);
    term = terms_.apply(Operator::logical_not, column, {operand});
  } else {
    cursor_->go_to(begin);
    term = power();
  }
  --depth_;
  return term;
}

Term ExpressionReader::power() {
  Term base = primary();
  cursor_->skip_blank();
  if (failed_ || cursor_->peek() != '^') return base;
  const std::uint32_t column = cursor_->column();
  cursor_->skip();
  const Term exponent = unary();
  if (failed_) return exponent;
  return combine({Operator::power, 7, 1}, column, base, exponent);
}

Term ExpressionReader::primary() {
  cursor_->skip_blank();
  const std::uint32_t column = cursor_->column();
  const char c = cursor_->peek();
  if (is_digit(c) || c == '.') return number();
  if (c == '(') {
    cursor_->skip();
    const Term inner = binary(1);
    if (failed_) return inner;
    if (!cursor_->take(')')) return syntax_error(cursor_->column(), "a ')' is missing", "close the bracket");
    return components(inner);
  }
  if (is_letter(c)) {
    const std::string_view text = cursor_->name();
    const std::optional<Word> which = find_word(text);
    const Term term = which ? word(*which, text, column) : symbol(text, column);
    return failed_ ? term : components(term);
  }
  if (cursor_->at_end()) return syntax_error(column, "a value is missing", "write a number, a name or an expression");
  return syntax_error(column, fmt::format("'{}' cannot begin a value", printable(std::string_view(&c, 1))),
                      "write a number, a name or an expression");
}

Term ExpressionReader::number() {
  const std::uint32_t column = cursor_->column();
  bool whole = true;
  const std::string_view text = cursor_->number(whole);
  if (text.empty()) return syntax_error(column, "a decimal point alone is not a number", "write digits with it");
  if (is_letter(cursor_->peek()))
    return syntax_error(
        column, fmt::format("'{}{}...' is not a number", printable(text, 30), cursor_->peek()),
        "numbers have digits, a decimal point and an exponent only; put an operator between numbers and names");
  if (whole) {
    std::int64_t value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error == std::errc{}) return integer_literal(value, column);
    return syntax_error(column, fmt::format("{} is too large for an integer", printable(text, 30)),
                        "write it with a decimal point as a real");
  }
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || !std::isfinite(value))
    return syntax_error(column, fmt::format("{} is beyond the range of a real", printable(text, 30)),
                        "write a smaller exponent");
  return real_literal(value, column);
}

Term ExpressionReader::components(Term term) {
  while (!failed_ && cursor_->peek() == '.') {
    cursor_->skip();
    term = component(term);
  }
  return term;
}

Term ExpressionReader::component(const Term& term) {
  const std::uint32_t column = cursor_->column();
  const std::string_view text = cursor_->name();
  if (text.empty())
    return syntax_error(column, "a component is missing after '.'", "write X, Y, Z, ROLL, PITCH, YAW or J1, J2, ...");
  if (!term.known) return term;
  Term out;
  out.column = term.column;
  if (term.type == ValueType::pose) {
    if (const auto index = find_pose_component(text)) {
      out = terms_.apply(Operator::component, term.column, {term}, *index);
      return terms_.scaled(out, written_per_si(*index));
    }
  } else if (term.type == ValueType::joints) {
    if (const auto index = find_joint_component(text))
      return terms_.apply(Operator::component, term.column, {term}, *index);
  } else {
    terms_.findings().error(column, fmt::format("{} has no components", with_article(term.type)),
                            "only poses and joint values have components");
    return out;
  }
  terms_.findings().error(column, fmt::format("{} has no component '{}'", with_article(term.type), printable(text, 30)),
                          term.type == ValueType::pose ? "write X, Y, Z, ROLL, PITCH or YAW"
                                                       : fmt::format("write J1 to J{}", kMaxJointsPerRobot));
  return out;
}

}  // namespace cellmirror::program::irdata
