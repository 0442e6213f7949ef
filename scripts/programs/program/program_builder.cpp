#include "scripts/programs/program/program_builder.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

#include "rt_core/base/contract.hpp"
#include "scripts/programs/program/program_check.hpp"

namespace cellmirror::program {
namespace {

constexpr std::uint32_t kWidestColumn = 0xFFFF;

// Leaves whose payload is the name of something of the program, and not a value to compute with.
bool names_something(Operator which) {
  return which == Operator::constant || which == Operator::variable || which == Operator::element;
}

}  // namespace

ProgramBuilder::ProgramBuilder(std::string name, std::string_view language, std::string file)
    : program_(std::make_shared<Program>()) {
  program_->name = std::move(name);
  program_->language = language;
  program_->file = std::move(file);
}

void ProgramBuilder::reserve(std::size_t statements) {
  const std::size_t count = std::min(statements, kMostStatements);
  program_->statements.reserve(count);
  program_->places.reserve(count);
  program_->expressions.reserve(count);
  program_->constants.reserve(count);
  types_.reserve(count);
  depths_.reserve(count);
}

void ProgramBuilder::push_node(const ExpressionNode& node, ValueType type, std::uint8_t depth) {
  program_->expressions.push_back(node);
  types_.push_back(type);
  depths_.push_back(depth);
}

ExpressionId ProgramBuilder::constant(Value value) {
  const ValueType type = type_of(value);
  const ExpressionNode node{.which = Operator::constant,
                            .payload = static_cast<std::uint32_t>(program_->constants.size())};
  program_->constants.push_back(std::move(value));
  push_node(node, type, 1);
  return static_cast<ExpressionId>(program_->expressions.size() - 1);
}

Result<ExpressionId> ProgramBuilder::variable(VariableId id) {
  CELLMIRROR_EXPECTS(id < program_->variables.size());
  const ExpressionNode node{.which = Operator::variable, .payload = id};
  const auto type = node_type(*program_, node, {});
  if (!type) return std::unexpected(type.error());
  push_node(node, *type, 1);
  return static_cast<ExpressionId>(program_->expressions.size() - 1);
}

Result<ValueType> ProgramBuilder::operation_type(Operator which, std::span<const ExpressionId> operands,
                                                 std::uint32_t payload) const {
  std::array<ValueType, kMaxJointsPerRobot> types{};
  if (operands.size() > types.size()) {
    return fail(fmt::format("'{}' takes at most {} operands", name_of(which), types.size()));
  }
  std::transform(operands.begin(), operands.end(), types.begin(), [&](ExpressionId operand) {
    CELLMIRROR_EXPECTS(operand < types_.size());
    return types_[operand];
  });
  return node_type(*program_, {.which = which, .payload = payload}, std::span(types).first(operands.size()));
}

// How many nodes the constants of an operation take at the end of the program; 0 if they are used elsewhere too.
std::size_t ProgramBuilder::foldable_tail(std::span<const ExpressionId> operands) const {
  const std::size_t nodes = program_->expressions.size();
  const std::size_t constants = program_->constants.size();
  const std::size_t count = operands.size();
  if (count > nodes || count > constants) return 0;
  for (std::size_t index = 0; index < count; ++index) {
    if (operands[index] != nodes - count + index) return 0;
    const ExpressionNode& node = program_->expressions[operands[index]];
    if (node.which != Operator::constant || node.payload != constants - count + index) return 0;
  }
  return count;
}

Result<std::optional<ExpressionId>> ProgramBuilder::fold(Operator which, std::span<const ExpressionId> operands,
                                                         std::uint32_t payload) {
  if (reads_world(which) || names_something(which)) return std::nullopt;
  const std::size_t count = foldable_tail(operands);
  if (count == 0) return std::nullopt;
  auto value = apply(which, std::span<const Value>(program_->constants).last(count), payload);
  if (!value) return fail(std::move(value.error().what), "change the values");
  program_->expressions.resize(program_->expressions.size() - count);
  program_->constants.resize(program_->constants.size() - count);
  types_.resize(program_->expressions.size());
  depths_.resize(program_->expressions.size());
  return constant(std::move(*value));
}

Result<ExpressionId> ProgramBuilder::operation(Operator which, std::span<const ExpressionId> operands,
                                               std::uint32_t payload) {
  CELLMIRROR_EXPECTS(which != Operator::constant && which != Operator::variable);
  const auto type = operation_type(which, operands, payload);
  if (!type) return std::unexpected(type.error());
  const auto folded = fold(which, operands, payload);
  if (!folded) return std::unexpected(folded.error());
  if (*folded) return **folded;
  const ExpressionNode node{.which = which,
                            .operands = static_cast<std::uint8_t>(operands.size()),
                            .first_operand = static_cast<std::uint32_t>(program_->operands.size()),
                            .payload = payload};
  std::uint8_t depth = 0;
  for (const ExpressionId operand : operands) {
    depth = std::max(depth, depths_[operand]);
  }
  if (depth >= kMostExpressionDepth) {
    return fail(fmt::format("the expression is nested more than {} deep", kMostExpressionDepth),
                "compute parts of it first");
  }
  program_->operands.insert(program_->operands.end(), operands.begin(), operands.end());
  push_node(node, *type, static_cast<std::uint8_t>(depth + 1));
  return static_cast<ExpressionId>(program_->expressions.size() - 1);
}

Result<ExpressionId> ProgramBuilder::operation(Operator which, std::initializer_list<ExpressionId> operands,
                                               std::uint32_t payload) {
  return operation(which, std::span(operands.begin(), operands.size()), payload);
}

Result<VariableId> ProgramBuilder::declare(std::string_view name, ValueType type, std::optional<Value> initial) {
  if (program_->variables.size() >= kMostVariables) {
    return fail(fmt::format("more than {} variables", kMostVariables));
  }
  Value value = initial ? std::move(*initial) : default_value(type);
  if (type == ValueType::real && type_of(value) == ValueType::integer) {
    value = static_cast<double>(std::get<std::int64_t>(value));
  }
  if (type_of(value) != type) {
    return fail(fmt::format("'{}' is {}, its initial value is {}", name, name_of(type), name_of(type_of(value))));
  }
  const auto id = static_cast<VariableId>(program_->variables.size());
  if (!variables_.emplace(name, id).second) return fail(fmt::format("'{}' is declared twice", name));
  Variable variable;
  variable.name = name;
  variable.type = type;
  variable.initial.push_back(std::move(value));
  program_->variables.push_back(std::move(variable));
  return id;
}

Result<VariableId> ProgramBuilder::declare_list(std::string_view name, ValueType type, std::int64_t first,
                                                std::size_t count, std::vector<Value> initial) {
  if (count == 0 || initial.size() > count) {
    return fail(fmt::format("the list '{}' has {} elements and {} initial values", name, count, initial.size()));
  }
  if (count > kMostListElements - list_elements_) {
    return fail(fmt::format("'{}' has {} elements: all lists together may have {}", name, count, kMostListElements));
  }
  constexpr std::int64_t kFarthest = 1'000'000'000;
  if (first < -kFarthest || first > kFarthest) {
    return fail(fmt::format("the list '{}' begins with index {}", name, first), "begin with 0 or 1");
  }
  for (Value& value : initial) {
    if (type == ValueType::real && type_of(value) == ValueType::integer) {
      value = static_cast<double>(std::get<std::int64_t>(value));
    }
    if (type_of(value) != type) {
      return fail(fmt::format("the elements of '{}' are {}, one of its initial values is {}", name, name_of(type),
                              name_of(type_of(value))));
    }
  }
  auto id = declare(name, type);
  if (!id) return id;
  list_elements_ += count;
  initial.resize(count, default_value(type));
  Variable& variable = program_->variables[*id];
  variable.list = true;
  variable.first = first;
  variable.initial = std::move(initial);
  return id;
}

std::optional<VariableId> ProgramBuilder::find_variable(std::string_view name) const {
  const auto found = variables_.find(std::string(name));
  if (found == variables_.end()) return std::nullopt;
  return found->second;
}

void ProgramBuilder::at(std::uint32_t line, std::uint32_t column, std::string_view label) {
  place_.line = line;
  place_.column = static_cast<std::uint16_t>(std::min(column, kWidestColumn));
  place_.label = label.empty() ? kNone : text(label);
}

TextId ProgramBuilder::text(std::string_view text) {
  program_->texts.emplace_back(text);
  return static_cast<TextId>(program_->texts.size() - 1);
}

void ProgramBuilder::append(const Statement& statement) {
  if (program_->statements.size() >= kMostStatements) {
    too_long_ = true;
    return;
  }
  program_->statements.push_back(statement);
  program_->places.push_back(place_);
}

Result<void> ProgramBuilder::add(const Statement& statement) {
  CELLMIRROR_EXPECTS(!std::holds_alternative<JumpStatement>(statement) &&
                     !std::holds_alternative<BranchStatement>(statement) &&
                     !std::holds_alternative<CallStatement>(statement));
  if (auto checked = check_statement(*program_, types_, statement); !checked) return checked;
  append(statement);
  return {};
}

ProgramBuilder::Label ProgramBuilder::new_label() {
  labels_.push_back(kNone);
  return {static_cast<std::uint32_t>(labels_.size() - 1)};
}

void ProgramBuilder::bind(Label label) {
  CELLMIRROR_EXPECTS(!bound(label));
  labels_[label.id] = next_statement();
}

// Until build() the targets of jumps are labels.
void ProgramBuilder::jump(Label label) { append(JumpStatement{label.id}); }

Result<void> ProgramBuilder::branch_unless(ExpressionId condition, Label label) {
  const BranchStatement branch{.condition = condition, .target = label.id};
  if (auto checked = check_statement(*program_, types_, branch); !checked) return checked;
  append(branch);
  return {};
}

void ProgramBuilder::call(Label label) { append(CallStatement{label.id}); }

Result<void> ProgramBuilder::declare_semaphore(std::string_view name, std::uint32_t initial, std::uint32_t line) {
  for (const SemaphoreDeclaration& declared : program_->semaphores) {
    if (declared.name != name) continue;
    if (declared.initial == initial) return {};
    return fail(fmt::format("the semaphore '{}' is declared with {} and, in line {}, with {}", name, initial,
                            declared.line, declared.initial));
  }
  if (program_->semaphores.size() >= kMostSemaphores)
    return fail(fmt::format("more than {} semaphores", kMostSemaphores));
  program_->semaphores.push_back({std::string(name), initial, line});
  return {};
}

// A label that is nowhere becomes a target beyond the program, which check_program() reports.
void ProgramBuilder::patch_jumps() {
  for (Statement& statement : program_->statements) {
    StatementId* target = nullptr;
    if (auto* jump = std::get_if<JumpStatement>(&statement)) target = &jump->target;
    if (auto* branch = std::get_if<BranchStatement>(&statement)) target = &branch->target;
    if (auto* call = std::get_if<CallStatement>(&statement)) target = &call->target;
    if (target != nullptr) *target = *target < labels_.size() ? labels_[*target] : kNone;
  }
}

std::shared_ptr<const Program> ProgramBuilder::build(Diagnostics& diagnostics,
                                                     std::shared_ptr<const Program>* read_part) {
  patch_jumps();
  if (too_long_) {
    diagnostics.error(program_->place(static_cast<StatementId>(program_->statements.size() - 1)),
                      fmt::format("the program has more than {} statements", kMostStatements),
                      "split it into several programs");
  }
  check_program(*program_, diagnostics);
  auto program = std::exchange(program_, nullptr);
  if (read_part != nullptr) *read_part = program;
  if (!diagnostics.ok()) return nullptr;
  return program;
}

}  // namespace cellmirror::program
