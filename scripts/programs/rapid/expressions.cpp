// Arithmetic, names and functions. relations.cpp has the conditions, aggregates.cpp the lists.
#include "scripts/programs/rapid/expressions.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include "rt_core/base/text.hpp"
#include "rt_core/base/units.hpp"
#include "scripts/programs/rapid/expression_nesting.hpp"

namespace cellmirror::program::rapid {

struct ExpressionReader::FunctionRow {
  std::string_view name;  // in upper case
  Operator which;
  std::size_t operands;
  double in = 1;  // what is written, times this, is SI
  double out = 1;
};

namespace {

constexpr double kToDegrees = 1 / kRadPerDeg;

}  // namespace

Place ExpressionReader::place(const Token& at) const {
  return {file_, static_cast<int>(at.line), static_cast<int>(at.column)};
}

void ExpressionReader::error(const Token& at, std::string message, std::string remedy) {
  found_.error(place(at), std::move(message), std::move(remedy));
}

void ExpressionReader::error(const Token& at, const Error& error) {
  found_.error(place(at), error.what, error.remedy.empty() ? "change the expression" : error.remedy);
}

void ExpressionReader::warn_once(bool& told, const Token& at, std::string message, std::string remedy) {
  if (!std::exchange(told, true)) found_.warning(place(at), std::move(message), std::move(remedy));
}

std::string ExpressionReader::proposal(std::string_view wrong, const std::vector<std::string>& candidates,
                                       std::string_view otherwise) {
  std::string text;
  // To a single letter everything short is near.
  if (wrong.size() > 1 && candidates.size() <= proposals_left_) {
    proposals_left_ -= candidates.size();
    text = did_you_mean(wrong, candidates);
  }
  return text.empty() ? std::string(otherwise) : text;
}

bool ExpressionReader::expect(Sign sign, std::string_view spelled) {
  if (lexer_.at(sign)) {
    lexer_.advance();
    return true;
  }
  error(lexer_.token(), fmt::format("'{}' is missing before {}", spelled, shown(lexer_.token())),
        fmt::format("write '{}' here", spelled));
  return false;
}

bool ExpressionReader::expect_word(std::string_view word) {
  if (lexer_.at(word)) {
    lexer_.advance();
    return true;
  }
  error(lexer_.token(), fmt::format("{} is missing before {}", word, shown(lexer_.token())),
        fmt::format("write {} here", word));
  return false;
}

const Declared* ExpressionReader::find(const Token& name) {
  if (const Declared* const declared = names_.find(name.text)) {
    return declared->storage == Declared::Storage::unusable ? nullptr : declared;
  }
  std::vector<std::string> candidates;
  if (name.text.size() > 1 && names_.size() <= proposals_left_) candidates = names_.all();
  error(name, fmt::format("{} is not declared", shown(name)),
        proposal(name.text, candidates, "declare it before, as in 'VAR num n;' or 'CONST robtarget p1:=[...];'"));
  names_.forgive(name.text);
  return nullptr;
}

std::optional<Operand> ExpressionReader::read(Type wanted, std::string_view what) {
  const Token at = lexer_.token();
  std::optional<Operand> operand;
  if (lexer_.at(Sign::open_list) && (wanted == Type::robtarget || wanted == Type::jointtarget)) {
    operand = read_list(wanted);
  } else {
    operand = whole();
  }
  if (!operand || !operand->known() || operand->type == wanted) return operand;
  error(at, fmt::format("{} is {}, but {} is needed here", what, word_of(operand->type), word_of(wanted)),
        operand->type == Type::signal_in || operand->type == Type::signal_out
            ? "compare the signal, as in di1 = 1"
            : fmt::format("write a value of {}", word_of(wanted)));
  return Operand{};
}

std::optional<Value> ExpressionReader::read_constant(Type wanted, std::string_view what, bool& known) {
  const Token at = lexer_.token();
  const std::optional<Operand> operand = read(wanted, what);
  known = operand && operand->known();
  if (!operand) return std::nullopt;
  if (!known) return Value{};
  if (const Value* const value = builder_.constant_value(operand->id)) return *value;
  known = false;
  error(at, fmt::format("{} has to be constant", what), "use numbers and data declared with CONST");
  return Value{};
}

std::optional<Operand> ExpressionReader::read_target(Type list) {
  const Token at = lexer_.token();
  const std::optional<Operand> target = lexer_.at(Sign::open_list) ? read_list(list) : whole();
  if (!target || !target->known() || target->type == Type::robtarget || target->type == Type::jointtarget) {
    return target;
  }
  return wrong_type(at, "a move", "a robtarget or a jointtarget", *target);
}

Operand ExpressionReader::wrong_type(const Token& at, std::string_view what, std::string_view needs,
                                     const Operand& operand) {
  error(at, fmt::format("{} takes {}, but this is {}", what, needs, word_of(operand.type)),
        operand.type == Type::robtarget ? "use a component of it, as in p1.trans.x" : "write another value");
  return Operand{};
}

Operand ExpressionReader::combine(Operator which, Type type, std::initializer_list<ExpressionId> operands,
                                  const Token& at, std::uint32_t payload) {
  const Result<ExpressionId> made = builder_.operation(which, operands, payload);
  if (made) return Operand{type, *made};
  error(at, made.error());
  return Operand{};
}

Operand ExpressionReader::scaled(const Operand& number, double factor, const Token& at) {
  if (factor == 1 || !number.known()) return number;
  return combine(Operator::multiply, Type::num, {number.id, builder_.real(factor)}, at);
}

Operand ExpressionReader::arithmetic(Operator which, const Operand& left, const Operand& right, const Token& at) {
  if (!left.known() || !right.known()) return Operand{};
  if (left.type != Type::num) return wrong_type(at, shown(at), "numbers", left);
  if (right.type != Type::num) return wrong_type(at, shown(at), "numbers", right);
  if (which == Operator::integer_divide || which == Operator::modulo) return whole_numbers(which, left, right, at);
  return combine(which, Type::num, {left.id, right.id}, at);
}

// DIV and MOD: num has no whole numbers of its own, so the nearest ones are taken.
Operand ExpressionReader::whole_numbers(Operator which, const Operand& left, const Operand& right, const Token& at) {
  const std::array operands = {left, right};
  std::array<std::optional<std::int64_t>, 2> constants;
  for (std::size_t i = 0; i < operands.size(); ++i) {
    const Value* const value = builder_.constant_value(operands.at(i).id);
    if (value == nullptr) continue;
    const double number = std::get<double>(*value);
    constexpr double kMost = 1e15;  // whole numbers are exact up to here
    if (number != std::round(number) || std::abs(number) > kMost) {
      error(at, fmt::format("{} takes whole numbers, but this is {}", shown(at), number), "round it, or write '/'");
      return Operand{};
    }
    constants.at(i) = static_cast<std::int64_t>(number);
  }
  Operand result;
  if (constants[0] && constants[1]) {
    result = combine(which, Type::num, {builder_.integer(*constants[0]), builder_.integer(*constants[1])}, at);
  } else {
    const Operand a = combine(Operator::round, Type::num, {left.id}, at);
    const Operand b = combine(Operator::round, Type::num, {right.id}, at);
    if (a.known() && b.known()) result = combine(which, Type::num, {a.id, b.id}, at);
  }
  return result.known() ? combine(Operator::to_real, Type::num, {result.id}, at) : result;
}

std::optional<Operand> ExpressionReader::sum() {
  std::optional<Operand> left = product();
  while (left && (lexer_.at(Sign::plus) || lexer_.at(Sign::minus))) {
    const Token at = lexer_.token();
    lexer_.advance();
    const std::optional<Operand> right = product();
    if (!right) return std::nullopt;
    left = arithmetic(at.sign == Sign::plus ? Operator::add : Operator::subtract, *left, *right, at);
  }
  return left;
}

namespace {

std::optional<Operator> product_operator(const Token& token) {
  if (token.sign == Sign::times) return Operator::multiply;
  if (token.sign == Sign::divide) return Operator::divide;
  if (token.is("DIV")) return Operator::integer_divide;
  if (token.is("MOD")) return Operator::modulo;
  return std::nullopt;
}

}  // namespace

std::optional<Operand> ExpressionReader::product() {
  std::optional<Operand> left = primary();
  while (left) {
    const Token at = lexer_.token();
    const std::optional<Operator> which = product_operator(at);
    if (!which) return left;
    lexer_.advance();
    const std::optional<Operand> right = primary();
    if (!right) return std::nullopt;
    left = arithmetic(*which, *left, *right, at);
  }
  return left;
}

std::optional<Operand> ExpressionReader::primary() {
  const Nesting nesting(*this);
  if (!nesting.fits()) return std::nullopt;
  const Token at = lexer_.token();
  if (at.kind == TokenKind::word) return named();
  switch (at.kind) {
    case TokenKind::number:
      lexer_.advance();
      return Operand{Type::num, builder_.real(at.value)};
    case TokenKind::bad_number:
      error(at, fmt::format("{} is not a number", shown(at)), "write digits, a point and an exponent, as in 1.5E3");
      return std::nullopt;
    case TokenKind::sign:
      break;
    default:
      error(at, fmt::format("a value is missing before {}", shown(at)), "write a number, a name or a function");
      return std::nullopt;
  }
  if (at.sign == Sign::open) {
    lexer_.advance();
    const std::optional<Operand> inner = whole();
    if (!inner || !expect(Sign::close, ")")) return std::nullopt;
    return inner;
  }
  if (at.sign == Sign::plus || at.sign == Sign::minus) {
    lexer_.advance();
    const std::optional<Operand> operand = primary();
    if (!operand || !operand->known()) return operand;
    if (operand->type != Type::num) return wrong_type(at, shown(at), "a number", *operand);
    return at.sign == Sign::plus ? *operand : combine(Operator::negate, Type::num, {operand->id}, at);
  }
  if (at.sign == Sign::open_list) {
    error(at, "a list [...] is not allowed here", "declare it with CONST, and write its name");
    return std::nullopt;
  }
  error(at, fmt::format("a value is missing before {}", shown(at)), "write a number, a name or a function");
  return std::nullopt;
}

Operand ExpressionReader::value_of(const Declared& declared) {
  if (declared.storage == Declared::Storage::constant) {
    return Operand{declared.type, builder_.constant(declared.value)};
  }
  const Result<ExpressionId> made = builder_.variable(declared.variable);
  return made ? Operand{declared.type, *made} : Operand{};
}

namespace {

// Words that stand behind a value, or begin one.
bool is_reserved(const Token& token) {
  constexpr auto kReserved = std::to_array<std::string_view>(
      {"THEN", "DO", "FROM", "TO", "STEP", "AND", "OR", "XOR", "NOT", "DIV", "MOD", "ENDIF", "ENDFOR", "ENDWHILE"});
  return std::ranges::any_of(kReserved, [&](std::string_view word) { return token.is(word); });
}

}  // namespace

std::optional<Operand> ExpressionReader::named() {
  const Token name = lexer_.token();
  if (is_reserved(name)) {
    error(name, fmt::format("a value is missing before {}", shown(name)),
          name.is("NOT") ? "write NOT (...) in brackets" : "write a number, a name or a function");
    return std::nullopt;
  }
  lexer_.advance();
  if (name.is("TRUE") || name.is("FALSE")) return Operand{Type::boolean, builder_.boolean(name.is("TRUE"))};
  if (lexer_.at(Sign::open)) {
    static constexpr auto kFunctions = std::to_array<FunctionRow>({
        {"ABS", Operator::absolute, 1},
        {"SQRT", Operator::square_root, 1},
        {"POW", Operator::power, 2},
        {"SIN", Operator::sine, 1, kRadPerDeg, 1},
        {"COS", Operator::cosine, 1, kRadPerDeg, 1},
        {"TAN", Operator::tangent, 1, kRadPerDeg, 1},
        {"ASIN", Operator::arc_sine, 1, 1, kToDegrees},
        {"ACOS", Operator::arc_cosine, 1, 1, kToDegrees},
        {"ATAN2", Operator::arc_tangent, 2, 1, kToDegrees},
        {"ROUND", Operator::round, 1},
        {"TRUNC", Operator::truncate, 1},
    });
    lexer_.advance();
    if (name.is("OFFS")) return offset();
    if (name.is("TESTDI")) return test_signal(false);
    const auto* const row = std::ranges::find_if(kFunctions, [&](const FunctionRow& one) { return name.is(one.name); });
    if (row != kFunctions.end()) return function(name, *row);
    error(name, fmt::format("the function {} is not in the subset", shown(name)),
          "use Offs, TestDI, Abs, Sqrt, Pow, Sin, Cos, Tan, ASin, ACos, ATan2, Round or Trunc");
    return std::nullopt;
  }
  if (names_.find(name.text) == nullptr) {
    if (const std::optional<SignalName> signal = signal_of(name.text)) {
      return Operand{signal->output ? Type::signal_out : Type::signal_in, kNoExpression, signal->number};
    }
    if (name.is("HIGH") || name.is("LOW")) return Operand{Type::num, builder_.real(name.is("HIGH") ? 1 : 0)};
    if (name.is("PI")) return Operand{Type::num, builder_.real(std::numbers::pi)};
  }
  const Declared* const declared = find(name);
  if (lexer_.at(Sign::open_index)) {
    error(lexer_.token(), "arrays are not in the subset", "write single data, as in p1, p2, p3");
    return std::nullopt;
  }
  if (!lexer_.at(Sign::dot)) {
    if (declared == nullptr) return Operand{};
    if (declared->type == Type::speeddata) return wrong_type(name, "an expression", "numbers", {Type::speeddata, 0, 0});
    return value_of(*declared);
  }
  const Token dot = lexer_.token();
  const std::optional<Component> component = read_component(declared == nullptr ? Type::unknown : declared->type);
  if (!component) return std::nullopt;
  if (declared == nullptr) return Operand{};
  const Operand whole_value = value_of(*declared);
  if (!whole_value.known()) return whole_value;
  return scaled(combine(Operator::component, Type::num, {whole_value.id}, dot, component->index),
                1 / component->si_factor, dot);
}

std::optional<Operand> ExpressionReader::function(const Token& name, const FunctionRow& row) {
  std::array<Operand, 2> operands;
  for (std::size_t i = 0; i < row.operands; ++i) {
    if (i > 0 && !expect(Sign::comma, ",")) return std::nullopt;
    const Token at = lexer_.token();
    const std::optional<Operand> operand = read(Type::num, fmt::format("the argument of {}", name.text));
    if (!operand) return std::nullopt;
    operands.at(i) = scaled(*operand, row.in, at);
  }
  if (!expect(Sign::close, ")")) return std::nullopt;
  if (!operands[0].known() || (row.operands > 1 && !operands[1].known())) return Operand{};
  Operand result = row.operands > 1 ? combine(row.which, Type::num, {operands[0].id, operands[1].id}, name)
                                    : combine(row.which, Type::num, {operands[0].id}, name);
  const bool integer = row.which == Operator::round || row.which == Operator::truncate;
  if (integer && result.known()) result = combine(Operator::to_real, Type::num, {result.id}, name);
  return scaled(result, row.out, name);
}

// Offs(p, x, y, z): moved along the axes of the work object.
std::optional<Operand> ExpressionReader::offset() {
  const Token at = lexer_.token();
  const std::optional<Operand> target = read(Type::robtarget, "the first argument of Offs");
  if (!target) return std::nullopt;
  std::array<Operand, 3> shift;
  for (Operand& one : shift) {
    if (!expect(Sign::comma, ",")) return std::nullopt;
    const Token number_at = lexer_.token();
    const std::optional<Operand> number = read(Type::num, "a displacement of Offs");
    if (!number) return std::nullopt;
    one = scaled(*number, kMPerMm, number_at);
  }
  if (!expect(Sign::close, ")")) return std::nullopt;
  if (!target->known() || !std::ranges::all_of(shift, &Operand::known)) return Operand{};
  const auto level = [this] { return builder_.real(0); };
  const Operand displacement = combine(Operator::make_pose, Type::robtarget,
                                       {shift[0].id, shift[1].id, shift[2].id, level(), level(), level()}, at);
  if (!displacement.known()) return displacement;
  return combine(Operator::compose, Type::robtarget, {displacement.id, target->id}, at);
}

std::optional<ExpressionReader::Component> ExpressionReader::read_component(Type type) {
  const Token dot = lexer_.token();
  std::array<Token, 2> parts;
  std::size_t count = 0;
  while (lexer_.at(Sign::dot)) {
    lexer_.advance();
    if (lexer_.token().kind == TokenKind::word && count < parts.size()) parts.at(count) = lexer_.token();
    ++count;
    if (lexer_.token().kind == TokenKind::word) lexer_.advance();
  }
  if (type == Type::unknown) return Component{};
  if (type == Type::robtarget && count == 2 && parts[0].is("TRANS")) {
    constexpr std::array<std::string_view, 3> kWords = {"X", "Y", "Z"};
    for (std::uint32_t i = 0; i < kWords.size(); ++i) {
      if (parts[1].is(kWords.at(i))) return Component{i, kMPerMm};
    }
  }
  if (type == Type::jointtarget && count == 2 && parts[0].is("ROBAX")) {
    constexpr std::array<std::string_view, 6> kJoints = {"RAX_1", "RAX_2", "RAX_3", "RAX_4", "RAX_5", "RAX_6"};
    for (std::uint32_t i = 0; i < kJoints.size(); ++i) {
      if (parts[1].is(kJoints.at(i))) return Component{i, 1};
    }
  }
  std::string_view remedy = "write its name alone";
  if (type == Type::robtarget) remedy = "write .trans.x, .trans.y or .trans.z";
  if (type == Type::jointtarget) remedy = "write .robax.rax_1 .. .robax.rax_6";
  error(dot, fmt::format("{} has no such component in the subset", word_of(type)), std::string(remedy));
  return std::nullopt;
}

}  // namespace cellmirror::program::rapid
