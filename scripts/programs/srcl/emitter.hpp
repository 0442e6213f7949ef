// Writes the parts of a Program.
#pragma once

#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <span>
#include <string>

#include "rt_core/base/result.hpp"
#include "scripts/programs/program/program.hpp"
#include "scripts/programs/srcl/lexer.hpp"
#include "scripts/programs/srcl/operand.hpp"

namespace cellmirror::program::srcl {

class Emitter {
 public:
  explicit Emitter(Program& program) : program_(program) {}

  [[nodiscard]] Program& program() { return program_; }
  // The statement that add() will write next.
  [[nodiscard]] StatementId here() const { return static_cast<StatementId>(program_.statements.size()); }
  StatementId add(Statement statement, std::uint32_t line, std::uint32_t column);
  StatementId add(Statement statement, const Token& at) { return add(statement, at.line, at.column); }
  // What people call the next statement.
  void name_next(std::string label) { label_ = std::move(label); }
  // Of a jump, branch or call that was written with no target yet.
  void set_target(StatementId statement, StatementId target);

  ExpressionId constant(Value value);
  [[nodiscard]] Value value_of(const Operand& constant) const;
  // The expression of an operand; it must be known.
  ExpressionId expression(const Operand& operand);
  // `type` of the result. The depth is one more than that of the deepest operand.
  Operand node(Operator which, ValueType type, std::span<const Operand> operands, std::uint32_t payload = 0);
  Operand node(Operator which, ValueType type, std::initializer_list<Operand> operands, std::uint32_t payload = 0) {
    return node(which, type, std::span<const Operand>(operands.begin(), operands.size()), payload);
  }
  // All operands constant: the result, as the machine computes it.
  [[nodiscard]] Result<Operand> computed(Operator which, std::span<const Operand> operands, std::uint32_t payload);
  Operand stored(Value value);
  // A number as a real one; multiplied where the factor is not 1.
  Operand real(const Operand& number, double factor = 1);
  TextId text(std::string_view text);

  // Hidden variables have names that no program can write.
  VariableId add_variable(std::string name, ValueType type);

 private:
  Program& program_;
  std::string label_;
};

}  // namespace cellmirror::program::srcl
