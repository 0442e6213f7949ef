// Reads parameters: values, conditions, and assignment targets.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "scripts/programs/irdata/cursor.hpp"
#include "scripts/programs/irdata/expression_words.hpp"
#include "scripts/programs/irdata/symbols.hpp"
#include "scripts/programs/irdata/terms.hpp"

namespace cellmirror::program::irdata {

// Where a value goes.
struct AssignTarget {
  bool known = false;
  VariableId variable = 0;
  ExpressionId index = kNoExpression;
  std::uint32_t component = kNone;
  ValueType type = ValueType::real;  // of what is assigned
  double si_per_written = 1;         // of components of poses
  std::uint32_t column = 0;
};

class ExpressionReader {
 public:
  ExpressionReader(Terms& terms, Symbols& symbols) : terms_(terms), symbols_(symbols) {}

  // In the header constants alone are values.
  void in_header(bool header) { header_ = header; }
  // From the cursor on. After a syntax error syntax_failed() is true, the term unknown, and the cursor is at the error;
  // all other errors leave it after the expression.
  Term read(Cursor& cursor);
  AssignTarget read_target(Cursor& cursor);
  [[nodiscard]] bool syntax_failed() const { return failed_; }

 private:
  struct BinaryOperator {
    Operator which = Operator::add;
    int precedence = 0;
    std::size_t length = 0;  // in the text
  };
  Term syntax_error(std::uint32_t column, std::string message, std::string remedy = {});
  Term value();
  Term binary(int lowest);
  Term combine(const BinaryOperator& with, std::uint32_t column, const Term& left, const Term& right);
  [[nodiscard]] std::optional<BinaryOperator> peek_operator();
  Term unary();
  Term power();
  Term primary();
  Term number();
  Term word(Word which, std::string_view text, std::uint32_t column);
  Term symbol(std::string_view name, std::uint32_t column);
  const Symbol* known_symbol(std::string_view name, std::uint32_t column);
  Term components(Term term);
  Term component(const Term& term);
  // Reads "(a, b, ...)" onto the stack of arguments; where they begin there. None after a fault, with nothing on it.
  std::optional<std::size_t> arguments(std::string_view function, std::uint32_t column, std::size_t fewest,
                                       std::size_t most);
  [[nodiscard]] std::span<const Term> arguments_from(std::size_t begin) const {
    return std::span(arguments_).subspan(begin);
  }
  Term call(const FunctionRow& row, std::string_view text, std::uint32_t column);
  Term make_pose(std::uint32_t column);
  Term make_joints(std::uint32_t column);
  Term port(Operator which, std::string_view text, std::uint32_t column);
  Term list_bound(Word which, std::uint32_t column);
  Term list_index();
  // False, and reported: a constant index without an element.
  bool has_element(VariableId list, const Term& index);
  bool are_numbers(std::size_t begin, std::string_view function);
  void undeclared(std::string_view name, std::uint32_t column);

  static constexpr std::size_t kDeepest = 40;  // brackets, signs and NOT within each other: reading is recursive
  Terms& terms_;
  Symbols& symbols_;
  Cursor* cursor_ = nullptr;
  std::vector<Term> arguments_;  // of the calls that are being read, one behind the other
  std::size_t depth_ = 0;
  bool failed_ = false;
  bool header_ = false;
};

}  // namespace cellmirror::program::irdata
