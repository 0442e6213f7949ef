// check_program(): the program as a whole.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string>
#include <vector>

#include "rt_core/base/capacity.hpp"
#include "scripts/programs/program/program_check.hpp"

namespace cellmirror::program {
namespace {

// Null where a statement may be part of a program that runs backward; else why not.
const char* not_reversible(const Statement& statement) {
  if (const auto* move = std::get_if<MoveStatement>(&statement)) {
    const bool absolute = move->kind == TargetKind::joints_absolute || move->kind == TargetKind::pose_absolute;
    return absolute ? nullptr : "a relative move cannot be run backward";
  }
  if (const auto* set = std::get_if<SetStatement>(&statement)) {
    const bool of_motion = set->setting != Setting::tool && set->setting != Setting::zero_point;
    return of_motion ? nullptr : "a change of tool or zero point cannot be run backward";
  }
  const bool passed_over =
      std::holds_alternative<DelayStatement>(statement) || std::holds_alternative<OutputStatement>(statement) ||
      std::holds_alternative<ScriptStatement>(statement) || std::holds_alternative<PauseStatement>(statement);
  return passed_over ? nullptr : "this statement cannot be run backward";
}

void check_reversible(const Program& program, Diagnostics& diagnostics) {
  const auto constant = [&](ExpressionId id) { return id == kNoExpression || constant_value(program, id) != nullptr; };
  for (StatementId id = 0; id < program.statements.size(); ++id) {
    const Statement& statement = program.statements[id];
    if (const char* why = not_reversible(statement)) diagnostics.error(program.place(id), why);
    const auto* move = std::get_if<MoveStatement>(&statement);
    const auto* set = std::get_if<SetStatement>(&statement);
    const bool fixed = (move == nullptr || (constant(move->target) && constant(move->via))) &&
                       (set == nullptr || constant(set->value));
    if (!fixed) diagnostics.error(program.place(id), "a program that runs backward must have constant values only");
  }
}

const StatementId* jump_target(const Statement& statement) {
  if (const auto* jump = std::get_if<JumpStatement>(&statement)) return &jump->target;
  if (const auto* branch = std::get_if<BranchStatement>(&statement)) return &branch->target;
  if (const auto* call = std::get_if<CallStatement>(&statement)) return &call->target;
  return nullptr;
}

// The types of all expressions. False where a node names what is not there: then nothing else can be checked.
class ExpressionCheck {
 public:
  explicit ExpressionCheck(const Program& program) : program_(program) {}

  Result<std::vector<ValueType>> types() {
    types_.reserve(program_.expressions.size());
    depths_.reserve(program_.expressions.size());
    for (ExpressionId id = 0; id < program_.expressions.size(); ++id) {
      auto type = check_node(id);
      if (!type) return fail(fmt::format("expression {}: {}", id, type.error().what));
      types_.push_back(*type);
    }
    return std::move(types_);
  }

 private:
  Result<ValueType> check_node(ExpressionId id) {
    const ExpressionNode& node = program_.expressions[id];
    if (node.which > Operator::make_joints) return fail("no such operator");
    const Arity arity = arity_of(node.which);
    const bool there = node.operands >= arity.least && node.operands <= arity.most &&
                       node.first_operand <= program_.operands.size() &&
                       node.operands <= program_.operands.size() - node.first_operand;
    if (node.operands > 0 && !there) return fail("its operands are missing");
    std::array<ValueType, kMaxJointsPerRobot> operand_types{};
    std::size_t depth = 0;
    for (std::size_t index = 0; index < node.operands; ++index) {
      const ExpressionId operand = program_.operands[node.first_operand + index];
      if (operand >= id) return fail("an operand comes after it");
      operand_types.at(index) = types_[operand];
      depth = std::max<std::size_t>(depth, depths_[operand]);
    }
    if (depth >= kMostExpressionDepth) return fail(fmt::format("nested more than {} deep", kMostExpressionDepth));
    depths_.push_back(static_cast<std::uint8_t>(depth + 1));
    return node_type(program_, node, std::span(operand_types).first(node.operands));
  }

  const Program& program_;
  std::vector<ValueType> types_;
  std::vector<std::uint8_t> depths_;
};

void check_sizes(const Program& program, Diagnostics& diagnostics) {
  const auto too_many = [&](std::size_t count, std::size_t most, std::string_view what) {
    if (count > most) {
      diagnostics.error({.file = program.file}, fmt::format("{} {}: a program may have {}", count, what, most));
    }
  };
  std::size_t elements = 0;
  for (const Variable& variable : program.variables) {
    elements += variable.list ? variable.initial.size() : 0;
    const bool of_its_type =
        !variable.initial.empty() && std::all_of(variable.initial.begin(), variable.initial.end(),
                                                 [&](const Value& value) { return type_of(value) == variable.type; });
    if (!of_its_type) {
      diagnostics.error({.file = program.file},
                        fmt::format("'{}' has no initial value that is {}", variable.name, name_of(variable.type)));
    }
  }
  too_many(program.statements.size(), kMostStatements, "statements");
  too_many(elements, kMostListElements, "elements of lists");
  too_many(program.variables.size(), kMostVariables, "variables");
  too_many(program.semaphores.size(), kMostSemaphores, "semaphores");
  if (program.places.size() != program.statements.size()) {
    diagnostics.error({.file = program.file}, "statements without a place");
  }
}

}  // namespace

Result<ValueType> node_type(const Program& program, const ExpressionNode& node, std::span<const ValueType> operands) {
  if (node.which == Operator::constant) {
    if (node.payload >= program.constants.size()) return fail("no such constant");
    return type_of(program.constants[node.payload]);
  }
  if (node.which == Operator::variable || node.which == Operator::element) {
    if (node.payload >= program.variables.size()) return fail("no such variable");
    const Variable& variable = program.variables[node.payload];
    const bool list = node.which == Operator::element;
    if (list && !variable.list) return fail(fmt::format("'{}' is not a list", variable.name));
    if (!list && variable.list) return fail(fmt::format("'{}' is a list: which element?", variable.name));
    if (list) {
      if (const auto index = result_type(node.which, operands); !index) return index;
    }
    return variable.type;
  }
  return result_type(node.which, operands);
}

void check_program(const Program& program, Diagnostics& diagnostics) {
  check_sizes(program, diagnostics);
  const auto types = ExpressionCheck(program).types();
  if (!types) {
    diagnostics.error({.file = program.file}, types.error().what);
    return;
  }
  for (StatementId id = 0; id < program.statements.size(); ++id) {
    const Statement& statement = program.statements[id];
    if (const auto checked = check_statement(program, *types, statement); !checked) {
      diagnostics.error(program.place(id), checked.error().what, checked.error().remedy);
    }
    const StatementId* target = jump_target(statement);
    if (target != nullptr && *target > program.statements.size()) {
      diagnostics.error(program.place(id), "the target of the jump is not in the program");
    }
  }
  if (program.reversible) check_reversible(program, diagnostics);
}

}  // namespace cellmirror::program
