// Reads expressions: types are checked, constants computed, mm and degrees become SI where poses are made.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

#include "scripts/programs/srcl/emitter.hpp"
#include "scripts/programs/srcl/faults.hpp"
#include "scripts/programs/srcl/lexer.hpp"
#include "scripts/programs/srcl/names.hpp"
#include "scripts/programs/srcl/operand.hpp"

namespace cellmirror::program::srcl {

// A component of a pose or of joints: the text after the point.
struct Component {
  std::uint32_t index = 0;
  double si_factor = 1;  // of poses: what is written, times this, is SI. Joints are in degrees and mm by their units
};

// If a function returns nothing, the rest of the line cannot be read; the error has been reported. What can be read but
// is invalid (an unknown name, a wrong type) is reported, too, and gives an operand that is not known().
class ExpressionReader {
 public:
  ExpressionReader(Lexer& lexer, Emitter& emitter, const Names& names, Faults& faults)
      : lexer_(lexer), emitter_(emitter), names_(names), faults_(faults) {}

  std::optional<Operand> read();
  // With a value of this type; an integer becomes a real if required. `what` is used in errors: "the condition".
  std::optional<Operand> read(ValueType wanted, std::string_view what);
  // As above, and constant.
  std::optional<Operand> read_constant(ValueType wanted, std::string_view what);

  // "(number)" of an input or output, from 1 to kMostPorts.
  std::optional<Operand> read_port();
  // "(index)" of a list.
  std::optional<Operand> read_index(const Declared& list);
  // An index after an operand without one.
  void report_no_list(const Token& name);
  // ".X"; the token is the point.
  std::optional<Component> read_component(ValueType type);
  // Of a declared name; else the error is reported.
  const Declared* find(const Token& name);
  // Skips a sign, or reports that it is missing.
  bool expect(Sign sign, std::string_view spelled);
  bool expect(Keyword keyword);

 private:
  struct BinaryRow;
  class Nesting;

  std::optional<Operand> binary(int weakest);
  std::optional<Operand> prefix();
  std::optional<Operand> postfix();
  std::optional<Operand> primary();
  std::optional<Operand> named();
  std::optional<Operand> world_or_constant(Keyword keyword);
  std::optional<Operand> function();
  std::optional<Operand> make_pose();
  std::optional<Operand> make_joints();
  std::optional<std::size_t> arguments(std::span<Operand> to, std::size_t least, const Token& function);

  Operand apply_binary(const BinaryRow& row, Operand left, Operand right, const Token& at);
  Operand combine(Operator which, ValueType type, std::span<const Operand> operands, const Token& at,
                  std::uint32_t payload = 0);
  Operand wrong_type(const Token& at, std::string_view what, std::string_view needs, const Operand& operand);

  Lexer& lexer_;
  Emitter& emitter_;
  const Names& names_;
  Faults& faults_;
  int nesting_ = 0;
};

}  // namespace cellmirror::program::srcl
