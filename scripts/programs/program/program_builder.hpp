// Builds programs. A parser adds expressions and statements in the order of the text; the builder validates types and
// bounds, so that all languages have the same errors, and folds constants.
#pragma once

#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "rt_core/base/diagnostics.hpp"
#include "rt_core/base/result.hpp"
#include "scripts/programs/program/program.hpp"
#include "scripts/programs/program/program_check.hpp"

namespace cellmirror::program {

// One thread. Real-time class: worker threads. Refusals have no place: the parser adds it.
class ProgramBuilder {
 public:
  // `name`, `file`: as in Program. `language` is that of the registry.
  ProgramBuilder(std::string name, std::string_view language, std::string file);

  // About how many statements come, where that is known: saves time with long programs.
  void reserve(std::size_t statements);
  void rename(std::string name) { program_->name = std::move(name); }  // the header of the text has the name

  // ---- Expressions. An id belongs to the operation or statement that it is given to and is used once: what is
  // constant is folded and its operands are forgotten.
  ExpressionId constant(Value value);
  ExpressionId integer(std::int64_t value) { return constant(value); }
  ExpressionId real(double value) { return constant(value); }
  ExpressionId boolean(bool value) { return constant(value); }
  // Refused: a list without an index.
  Result<ExpressionId> variable(VariableId id);
  // `payload`: see Operator. Refused: a wrong number of operands, types that the operator does not take, nested too
  // deep, constants that it fails with (division by 0).
  Result<ExpressionId> operation(Operator which, std::span<const ExpressionId> operands, std::uint32_t payload = 0);
  Result<ExpressionId> operation(Operator which, std::initializer_list<ExpressionId> operands,
                                 std::uint32_t payload = 0);
  [[nodiscard]] ValueType type(ExpressionId id) const { return types_[id]; }
  // Null where it is not constant. Valid until the next call.
  [[nodiscard]] const Value* constant_value(ExpressionId id) const { return program::constant_value(*program_, id); }
  [[nodiscard]] std::optional<double> constant_number(ExpressionId id) const {
    return program::constant_number(*program_, id);
  }

  // ---- Variables; names as the language compares them (fold the case before). Refused: declared twice; more list
  // elements than kMostListElements in all; an initial value of another type.
  Result<VariableId> declare(std::string_view name, ValueType type, std::optional<Value> initial = {});
  // `count` elements with indices first .. first + count - 1; `initial`: the first of them, or all.
  Result<VariableId> declare_list(std::string_view name, ValueType type, std::int64_t first, std::size_t count,
                                  std::vector<Value> initial = {});
  [[nodiscard]] std::optional<VariableId> find_variable(std::string_view name) const;
  [[nodiscard]] const Variable& variable_of(VariableId id) const { return program_->variables[id]; }

  // ---- Statements. at() says where the following ones stand; `label`: name of the step ("N40", "check point
  // P3"), empty: its line.
  void at(std::uint32_t line, std::uint32_t column, std::string_view label = {});
  // Any but jumps, branches and calls. Refused: expressions of a wrong type, constants out of range.
  Result<void> add(const Statement& statement);
  TextId text(std::string_view text);
  // The number that the next statement will have.
  [[nodiscard]] StatementId next_statement() const { return static_cast<StatementId>(program_->statements.size()); }

  // ---- Jumps. A label may be used before it is bound; one that is used and never bound is an error of build().
  struct Label {
    std::uint32_t id = 0;
  };
  Label new_label();
  void bind(Label label);  // here: the next statement. Once
  [[nodiscard]] bool bound(Label label) const { return labels_[label.id] != kNone; }
  void jump(Label label);
  Result<void> branch_unless(ExpressionId condition, Label label);  // on where it is true, else to the label
  void call(Label label);

  // Refused: declared with another count before.
  Result<void> declare_semaphore(std::string_view name, std::uint32_t initial, std::uint32_t line);

  // The program may be run backward. build() reports statements that do not go with it (Program::reversible).
  void set_reversible() { program_->reversible = true; }

  // Reports what is wrong as a whole (labels, sizes). Null where `diagnostics` has errors, also those of the parser.
  // `read_part`: see ParseContext. Ends the builder.
  std::shared_ptr<const Program> build(Diagnostics& diagnostics, std::shared_ptr<const Program>* read_part = nullptr);

 private:
  void append(const Statement& statement);
  [[nodiscard]] std::size_t foldable_tail(std::span<const ExpressionId> operands) const;
  // None where it is not constant.
  Result<std::optional<ExpressionId>> fold(Operator which, std::span<const ExpressionId> operands,
                                           std::uint32_t payload);
  [[nodiscard]] Result<ValueType> operation_type(Operator which, std::span<const ExpressionId> operands,
                                                 std::uint32_t payload) const;
  void push_node(const ExpressionNode& node, ValueType type, std::uint8_t depth);
  void patch_jumps();

  std::shared_ptr<Program> program_;
  std::vector<ValueType> types_;      // of expressions
  std::vector<std::uint8_t> depths_;  // of expressions
  std::unordered_map<std::string, VariableId> variables_;
  std::size_t list_elements_ = 0;
  StatementPlace place_;
  std::vector<StatementId> labels_;  // by id; kNone: not bound yet
  bool too_long_ = false;
};

}  // namespace cellmirror::program
