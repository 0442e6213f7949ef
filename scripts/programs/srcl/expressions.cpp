#include "scripts/programs/srcl/expressions.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "rt_core/base/text.hpp"
#include "scripts/programs/srcl/keywords.hpp"

namespace cellmirror::program::srcl {

namespace {

constexpr int kMostNesting = 64;  // reading is recursive
// Nodes above each other; what units add stays below the bound of the machine.
constexpr std::uint8_t kMostDepth = kMostExpressionDepth - 8;

constexpr int kWeakest = 1;
constexpr int kComparison = 4;
constexpr int kProduct = 6;
constexpr int kPower = 8;

}  // namespace

struct ExpressionReader::BinaryRow {
  enum class Takes : std::uint8_t { numbers, integers, logic, order, equality };
  Operator which;
  Takes takes;
  int strength;
};

// Counts how deep the reader is in itself.
class ExpressionReader::Nesting {
 public:
  explicit Nesting(ExpressionReader& reader) : reader_(reader) { ++reader_.nesting_; }
  ~Nesting() { --reader_.nesting_; }
  Nesting(const Nesting&) = delete;
  Nesting& operator=(const Nesting&) = delete;
  // False, and reported, if it is too deep.
  [[nodiscard]] bool fits() const {
    if (reader_.nesting_ <= kMostNesting) return true;
    reader_.faults_.add(reader_.lexer_.token(), fmt::format("the expression is nested more than {} deep", kMostNesting),
                        "compute a part of it into a variable first");
    return false;
  }

 private:
  ExpressionReader& reader_;
};

std::optional<Operand> ExpressionReader::read() { return binary(kWeakest); }

std::optional<Operand> ExpressionReader::read(ValueType wanted, std::string_view what) {
  const Token at = lexer_.token();
  std::optional<Operand> operand = read();
  if (!operand || !operand->known() || operand->type == wanted) return operand;
  if (wanted == ValueType::real && operand->type == ValueType::integer) return emitter_.real(*operand);
  const bool rounds = wanted == ValueType::integer && operand->type == ValueType::real;
  faults_.add(
      at, fmt::format("{} is {}, but {} is needed here", what, word_of(operand->type), word_of(wanted)),
      rounds ? "write RUNDE(...) or GANZTEIL(...) around it" : fmt::format("write a value of {}", word_of(wanted)));
  return Operand{};
}

std::optional<Operand> ExpressionReader::read_constant(ValueType wanted, std::string_view what) {
  const Token at = lexer_.token();
  std::optional<Operand> operand = read(wanted, what);
  if (!operand || !operand->known() || operand->constant()) return operand;
  faults_.add(at, fmt::format("{} has to be constant", what), "use numbers and names declared with FEST");
  return Operand{};
}

bool ExpressionReader::expect(Sign sign, std::string_view spelled) {
  if (lexer_.token().sign == sign) {
    lexer_.advance();
    return true;
  }
  faults_.add(lexer_.token(), fmt::format("'{}' is missing before {}", spelled, shown(lexer_.token())),
              fmt::format("write '{}' here", spelled));
  return false;
}

bool ExpressionReader::expect(Keyword keyword) {
  const Token& token = lexer_.token();
  if (token.keyword == keyword) {
    lexer_.advance();
    return true;
  }
  faults_.add(token, fmt::format("{} is missing before {}", spelling(keyword), shown(token)),
              fmt::format("write {} here", spelling(keyword)));
  return false;
}

const Declared* ExpressionReader::find(const Token& name) {
  const Declared* const declared = names_.find(name.text);
  if (declared != nullptr) return declared;
  std::vector<std::string> candidates;
  if (faults_.may_propose(names_.size() + keyword_rows().size())) {
    candidates = names_.all();
    candidates.insert(candidates.end(), all_words().begin(), all_words().end());
  }
  faults_.add(name, fmt::format("{} is not declared", shown(name)),
              faults_.proposal(name.text, candidates, "declare it before, as in 'GANZ I' or 'LAGE P1'"));
  return nullptr;
}

namespace {

// What to do with a value of a type that does not fit.
std::string_view remedy_for(ValueType type) {
  switch (type) {
    case ValueType::boolean:
      return "decide with WENN instead, or write another value";
    case ValueType::integer:
      return "compare it, as in I > 0, or write another value";
    case ValueType::real:
      return "write RUNDE(...) or GANZTEIL(...) around it, or compare it, as in X > 0";
    case ValueType::pose:
      return "use a component of it, as in P.X";
    case ValueType::joints:
      return "use a component of it, as in S.A1";
  }
  return {};
}

}  // namespace

Operand ExpressionReader::wrong_type(const Token& at, std::string_view what, std::string_view needs,
                                     const Operand& operand) {
  faults_.add(at, fmt::format("{} takes {}, but this is {}", what, needs, word_of(operand.type)),
              std::string(remedy_for(operand.type)));
  return Operand{};
}

// Constant operands give a constant.
Operand ExpressionReader::combine(Operator which, ValueType type, std::span<const Operand> operands, const Token& at,
                                  std::uint32_t payload) {
  if (std::ranges::all_of(operands, &Operand::constant)) {
    const Result<Operand> result = emitter_.computed(which, operands, payload);
    if (result) return *result;
    faults_.add(at, result.error().what, "change the values");
    return Operand{};
  }
  const Operand result = emitter_.node(which, type, operands, payload);
  if (result.depth <= kMostDepth) return result;
  faults_.add(at, fmt::format("the expression has more than {} nested operations", kMostDepth),
              "compute a part of it into a variable first");
  return Operand{};
}

namespace {

template <class Row>
std::optional<Row> binary_row(const Token& token) {
  switch (token.sign) {
    case Sign::equal:
      return Row{Operator::equal, Row::Takes::equality, kComparison};
    case Sign::not_equal:
      return Row{Operator::not_equal, Row::Takes::equality, kComparison};
    case Sign::less:
      return Row{Operator::less, Row::Takes::order, kComparison};
    case Sign::less_equal:
      return Row{Operator::less_equal, Row::Takes::order, kComparison};
    case Sign::greater:
      return Row{Operator::greater, Row::Takes::order, kComparison};
    case Sign::greater_equal:
      return Row{Operator::greater_equal, Row::Takes::order, kComparison};
    case Sign::plus:
      return Row{Operator::add, Row::Takes::numbers, kComparison + 1};
    case Sign::minus:
      return Row{Operator::subtract, Row::Takes::numbers, kComparison + 1};
    case Sign::times:
      return Row{Operator::multiply, Row::Takes::numbers, kProduct};
    case Sign::divide:
      return Row{Operator::divide, Row::Takes::numbers, kProduct};
    case Sign::power:
      return Row{Operator::power, Row::Takes::numbers, kPower};
    default:
      break;
  }
  switch (token.keyword) {
    case Keyword::logical_or:
      return Row{Operator::logical_or, Row::Takes::logic, kWeakest};
    case Keyword::logical_xor:
      return Row{Operator::logical_xor, Row::Takes::logic, kWeakest};
    case Keyword::logical_and:
      return Row{Operator::logical_and, Row::Takes::logic, kWeakest + 1};
    case Keyword::integer_divide:
      return Row{Operator::integer_divide, Row::Takes::integers, kProduct};
    case Keyword::modulo:
      return Row{Operator::modulo, Row::Takes::integers, kProduct};
    default:
      return std::nullopt;
  }
}

}  // namespace

std::optional<Operand> ExpressionReader::binary(int weakest) {
  const Nesting nesting(*this);
  if (!nesting.fits()) return std::nullopt;
  std::optional<Operand> left = prefix();
  while (left) {
    const std::optional<BinaryRow> row = binary_row<BinaryRow>(lexer_.token());
    if (!row || row->strength < weakest) return left;
    const Token at = lexer_.token();
    lexer_.advance();
    // Powers are the only ones that bind to the right: 2^3^2 is 2^(3^2).
    const std::optional<Operand> right = binary(row->strength == kPower ? kPower : row->strength + 1);
    if (!right) return std::nullopt;
    left = apply_binary(*row, *left, *right, at);
  }
  return left;
}

Operand ExpressionReader::apply_binary(const BinaryRow& row, Operand left, Operand right, const Token& at) {
  if (!left.known() || !right.known()) return Operand{};
  const std::string sign = shown(at);
  const bool numbers = left.number() && right.number();
  const bool same = left.type == right.type;
  if (row.which == Operator::multiply && left.is(ValueType::pose) && right.is(ValueType::pose))
    return combine(Operator::compose, ValueType::pose, std::array{left, right}, at);
  const Operand& odd = left.number() ? right : left;  // the one that does not fit, where numbers are wanted
  switch (row.takes) {
    case BinaryRow::Takes::numbers:
      if (!numbers) return wrong_type(at, sign, "numbers", odd);
      break;
    case BinaryRow::Takes::integers: {
      const Operand& real = left.is(ValueType::integer) ? right : left;
      if (!real.is(ValueType::integer)) return wrong_type(at, sign, "whole numbers", real);
      break;
    }
    case BinaryRow::Takes::logic: {
      const bool fits = same && (left.is(ValueType::boolean) || left.is(ValueType::integer));
      const Operand& other = left.is(ValueType::boolean) || left.is(ValueType::integer) ? right : left;
      if (!fits) return wrong_type(at, sign, "two values of LOGIK, or two of GANZ", other);
      break;
    }
    case BinaryRow::Takes::order:
      if (!numbers) return wrong_type(at, sign, "numbers", odd);
      break;
    case BinaryRow::Takes::equality:
      if (!numbers && !(same && left.is(ValueType::boolean)))
        return wrong_type(at, sign, "two numbers, or two values of LOGIK", odd);
      break;
  }
  ValueType type = left.type == ValueType::real || right.type == ValueType::real ? ValueType::real : left.type;
  if (row.takes == BinaryRow::Takes::order || row.takes == BinaryRow::Takes::equality) type = ValueType::boolean;
  if (row.which == Operator::divide || row.which == Operator::power) {
    type = ValueType::real;
    left = emitter_.real(left);
    right = emitter_.real(right);
  }
  return combine(row.which, type, std::array{left, right}, at);
}

std::optional<Operand> ExpressionReader::prefix() {
  const Token at = lexer_.token();
  const bool negated = at.sign == Sign::minus;
  const bool inverted = at.keyword == Keyword::logical_not;
  if (!negated && !inverted && at.sign != Sign::plus) return postfix();
  lexer_.advance();
  const std::optional<Operand> operand = binary(inverted ? kComparison : kPower);
  if (!operand || !operand->known()) return operand;
  if (inverted) {
    if (!operand->is(ValueType::boolean) && !operand->is(ValueType::integer))
      return wrong_type(at, "NICHT", "a value of LOGIK or of GANZ", *operand);
    return combine(Operator::logical_not, operand->type, std::span(&*operand, 1), at);
  }
  if (!operand->number()) return wrong_type(at, shown(at), "a number", *operand);
  if (negated && operand->form == Operand::Form::real) return Operand::of(-operand->real);
  if (negated && operand->form == Operand::Form::integer && operand->integer >= 0)
    return Operand::of(-operand->integer);
  return negated ? combine(Operator::negate, operand->type, std::span(&*operand, 1), at) : operand;
}

std::optional<Operand> ExpressionReader::postfix() {
  std::optional<Operand> operand = primary();
  if (!operand || lexer_.token().sign != Sign::dot) return operand;
  if (!operand->known()) {  // passed over, so that the rest of the line is read
    lexer_.advance();
    const TokenKind kind = lexer_.token().kind;
    if (kind == TokenKind::name || kind == TokenKind::keyword) lexer_.advance();
    return operand;
  }
  const std::optional<Component> component = read_component(operand->type);
  if (!component) return std::nullopt;
  const Operand value = emitter_.node(Operator::component, ValueType::real, {*operand}, component->index);
  return emitter_.real(value, 1 / component->si_factor);
}

}  // namespace cellmirror::program::srcl
