// Expressions on their way into the program: a thin layer over the builder that keeps numbers as numbers until they are
// needed, so that signs and units are worked into them.
#pragma once

#include <cstdint>
#include <initializer_list>
#include <optional>
#include <span>
#include <string_view>

#include "scripts/programs/irdata/findings.hpp"
#include "scripts/programs/program/program_builder.hpp"

namespace cellmirror::program::irdata {

struct Term {
  bool known = false;    // else it has been reported, and nothing more is said about it
  bool literal = false;  // a number that is no node yet: `integer` or `real`, by the type
  ValueType type = ValueType::real;
  std::uint32_t column = 0;
  std::int64_t integer = 0;
  double real = 0;
  ExpressionId id = kNoExpression;

  [[nodiscard]] bool is_number() const { return type == ValueType::integer || type == ValueType::real; }
  [[nodiscard]] double number() const { return type == ValueType::integer ? static_cast<double>(integer) : real; }
};

[[nodiscard]] Term integer_literal(std::int64_t value, std::uint32_t column);
[[nodiscard]] Term real_literal(double value, std::uint32_t column);
// "a real", "joint values", for messages.
[[nodiscard]] std::string_view with_article(ValueType type);

class Terms {
 public:
  Terms(ProgramBuilder& builder, Findings& findings) : builder_(builder), findings_(findings) {}

  [[nodiscard]] ProgramBuilder& builder() { return builder_; }
  [[nodiscard]] Findings& findings() { return findings_; }

  // Each term is used once, as the builder's ids are. What does not go together is reported at `column`.
  Term apply(Operator which, std::uint32_t column, std::span<const Term> operands, std::uint32_t payload = 0);
  Term apply(Operator which, std::uint32_t column, std::initializer_list<Term> operands, std::uint32_t payload = 0) {
    return apply(which, column, std::span<const Term>(operands.begin(), operands.size()), payload);
  }
  Term value(const Value& value, std::uint32_t column);
  Term variable(VariableId id, std::uint32_t column);
  Term negated(const Term& term);
  Term as_real(const Term& number);
  // A number times a factor, as where millimetres become metres.
  Term scaled(const Term& number, double factor);
  // Of a known term.
  ExpressionId id(const Term& term);
  [[nodiscard]] std::optional<Value> constant(const Term& term) const;
  // The number of a term that is a constant number.
  [[nodiscard]] std::optional<double> constant_number(const Term& term) const;

 private:
  ProgramBuilder& builder_;
  Findings& findings_;
};

}  // namespace cellmirror::program::irdata
