// Reads values: types are checked by the builder and here, mm and degrees become SI where poses are made.
#pragma once

#include <cstdint>
#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "rt_core/base/diagnostics.hpp"
#include "scripts/programs/program/program_builder.hpp"
#include "scripts/programs/rapid/lexer.hpp"
#include "scripts/programs/rapid/names.hpp"
#include "scripts/programs/rapid/predefined.hpp"

namespace cellmirror::program::rapid {

struct Operand {
  Type type = Type::unknown;  // unknown: invalid, which has been reported
  ExpressionId id = kNoExpression;
  std::uint32_t port = 0;  // of signals

  [[nodiscard]] bool known() const { return type != Type::unknown; }
};

// x, y, z, q1 .. q4 of a robtarget, a value of a jointtarget: most are numbers as they are written, and no expression.
struct Scalar {
  double value = 0;
  ExpressionId id = kNoExpression;  // where it is not constant
  [[nodiscard]] bool constant() const { return id == kNoExpression; }
};

// If a function returns nothing, the rest of the statement cannot be read; the error has been reported. What can be
// read but is invalid (an unknown name, a wrong type) is reported, too, and gives an operand that is not known().
class ExpressionReader {
 public:
  ExpressionReader(Lexer& lexer, ProgramBuilder& builder, Names& names, std::string file, Diagnostics& found)
      : lexer_(lexer), builder_(builder), names_(names), file_(std::move(file)), found_(found) {}

  // A value of this type; of robtarget, jointtarget also [...]. `what` is used in errors: "the condition".
  std::optional<Operand> read(Type wanted, std::string_view what);
  // As above, and constant.
  std::optional<Value> read_constant(Type wanted, std::string_view what, bool& known);
  // robtarget or jointtarget, whichever it is; [...] is of type `list`.
  std::optional<Operand> read_target(Type list);
  // A name of speeddata, or [v_tcp, v_ori, v_leax, v_reax]. `known` is false where the value is invalid.
  std::optional<Speed> read_speed(bool& known);
  // di1 or do1, as asked for.
  std::optional<Operand> read_signal(bool output);
  // 0, 1, low, high: the level that is waited for or compared with.
  std::optional<bool> read_level();

  // .trans.x, .robax.rax_1; the token is the point.
  struct Component {
    std::uint32_t index = 0;
    double si_factor = 1;  // of what is written
  };
  std::optional<Component> read_component(Type type);
  // Null where it is not declared or unusable, which has been reported.
  const Declared* find(const Token& name);
  bool expect(Sign sign, std::string_view spelled);
  bool expect_word(std::string_view word);

  void error(const Token& at, std::string message, std::string remedy = {});
  void warn_once(bool& told, const Token& at, std::string message, std::string remedy);
  // The error of the builder at this place.
  void error(const Token& at, const Error& error);
  // "did you mean A or B?", or `otherwise`. The work of all proposals together is bounded.
  std::string proposal(std::string_view wrong, const std::vector<std::string>& candidates, std::string_view otherwise);
  [[nodiscard]] Place place(const Token& at) const;

 private:
  class Nesting;
  struct FunctionRow;

  std::optional<Operand> whole();        // OR, XOR
  std::optional<Operand> conjunction();  // AND
  std::optional<Operand> relation(bool& negated);
  std::optional<Operand> comparison();
  std::optional<Operand> sum();
  std::optional<Operand> product();
  std::optional<Operand> primary();
  std::optional<Operand> named();
  std::optional<Operand> function(const Token& name, const FunctionRow& row);
  std::optional<Operand> offset();
  std::optional<Operand> test_signal(bool output);
  Operand value_of(const Declared& declared);

  Operand arithmetic(Operator which, const Operand& left, const Operand& right, const Token& at);
  Operand whole_numbers(Operator which, const Operand& left, const Operand& right, const Token& at);
  Operand logic(Operator which, const Operand& left, const Operand& right, const Token& at);
  Operand compare(Operator which, const Operand& left, const Operand& right, const Token& at);
  Operand compare_signal(Operator which, const Operand& left, const Operand& right, const Token& at);
  Operand combine(Operator which, Type type, std::initializer_list<ExpressionId> operands, const Token& at,
                  std::uint32_t payload = 0);
  Operand scaled(const Operand& number, double factor, const Token& at);
  Operand wrong_type(const Token& at, std::string_view what, std::string_view needs, const Operand& operand);

  // aggregates.cpp
  std::optional<Operand> read_list(Type type);
  std::optional<Operand> read_robtarget();
  std::optional<Operand> read_jointtarget();
  bool read_scalars(std::vector<Scalar>& to, std::size_t count, std::string_view what);
  std::optional<Scalar> read_scalar(std::string_view what);
  bool check_external_axes(const std::vector<Scalar>& axes, const Token& at);
  Operand make_pose(const std::vector<Scalar>& trans, const std::vector<Scalar>& rot, const Token& at);
  ExpressionId expression(const Scalar& scalar, double factor);

  static constexpr std::size_t kMostComparisons = 100'000;  // of names, for proposals

  Lexer& lexer_;
  ProgramBuilder& builder_;
  Names& names_;
  std::string file_;
  Diagnostics& found_;
  int nesting_ = 0;
  bool told_configuration_ = false;
  std::size_t proposals_left_ = kMostComparisons;
};

}  // namespace cellmirror::program::rapid
