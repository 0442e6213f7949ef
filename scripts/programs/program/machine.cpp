#include "scripts/programs/program/machine.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "rt_core/base/contract.hpp"

namespace cellmirror::program {
namespace {

// The expressions that a statement evaluates before it emits its command; the condition of a wait is evaluated later.
struct Expressions {
  using List = std::array<ExpressionId, 3>;

  List operator()(const MoveStatement& move) const { return {move.target, move.via, kNoExpression}; }
  List operator()(const AssignStatement& assign) const { return {assign.index, assign.value, kNoExpression}; }
  List operator()(const BranchStatement& branch) const { return {branch.condition, kNoExpression, kNoExpression}; }
  List operator()(const DelayStatement& delay) const { return {delay.seconds, kNoExpression, kNoExpression}; }
  List operator()(const WaitStatement& wait) const { return {wait.timeout_s, kNoExpression, kNoExpression}; }
  List operator()(const OutputStatement& output) const { return {output.number, output.value, kNoExpression}; }
  List operator()(const SetStatement& set) const { return {set.value, kNoExpression, kNoExpression}; }
  List operator()(const auto& /*other*/) const { return {kNoExpression, kNoExpression, kNoExpression}; }
};

}  // namespace

Machine::Machine(std::shared_ptr<const Program> program, std::span<const JointKind> joints)
    : program_(std::move(program)), joints_(joints.begin(), joints.end()) {
  CELLMIRROR_EXPECTS(program_ != nullptr);
  first_value_.reserve(program_->variables.size());
  for (const Variable& variable : program_->variables) {
    first_value_.push_back(values_.size());
    values_.insert(values_.end(), variable.initial.begin(), variable.initial.end());
  }
  looks_.reserve(program_->expressions.size());
  for (const ExpressionNode& node : program_->expressions) {
    const auto operands = std::span(program_->operands).subspan(node.first_operand, node.operands);
    looks_.push_back(reads_world(node.which) ||
                     std::any_of(operands.begin(), operands.end(), [&](ExpressionId id) { return looks_[id]; }));
  }
}

bool Machine::looks(const Statement& statement) const {
  const auto expressions = std::visit(Expressions{}, statement);
  return std::any_of(expressions.begin(), expressions.end(),
                     [&](ExpressionId id) { return id != kNoExpression && looks_[id]; });
}

Machine::Step Machine::failed(StatementId statement, const Error& why) {
  failed_ = true;
  error_ = {
      .severity = Severity::error, .place = program_->place(statement), .message = why.what, .remedy = why.remedy};
  return Step::failed;
}

// What the newest wait leaves behind.
void Machine::end_wait() {
  const StatementId statement = *waiting_;
  waiting_.reset();
  const auto& wait = std::get<WaitStatement>(program_->statements[statement]);
  if (wait.timed_out != kNone) {
    values_[first_value_[wait.timed_out]] = timed_out_;
  } else if (timed_out_) {
    failed(statement, {"the wait timed out", ""});
  }
}

Machine::Step Machine::next(const ProgramWorld& world, std::size_t budget) {
  if (waiting_ && !failed_) end_wait();
  if (failed_) return Step::failed;
  if (direction_ == Direction::backward) return next_backward(world);
  for (std::size_t count = 0; count < budget; ++count) {
    if (position_ >= program_->statements.size()) return Step::ended;
    if (!rested_ && looks(program_->statements[position_])) {
      rested_ = true;
      command_ = {.statement = position_, .what = RestCommand{}};
      return Step::command;
    }
    const StatementId statement = position_;
    const Outcome outcome = execute(world);
    ++executed_;
    if (outcome == Outcome::failed) return Step::failed;
    if (outcome == Outcome::ended) return Step::ended;
    if (outcome == Outcome::command) {
      // Outputs read back what the program has set: only when it has been set.
      if (std::holds_alternative<OutputStatement>(program_->statements[statement])) rested_ = false;
      return Step::command;
    }
  }
  return Step::spent;
}

bool Machine::holds(const ProgramWorld& world) {
  if (!waiting_ || failed_) return true;
  const StatementId statement = *waiting_;
  const auto condition = evaluate(world, std::get<WaitStatement>(program_->statements[statement]).condition);
  if (!condition) {
    failed(statement, condition.error());
    return true;
  }
  return std::get<bool>(*condition);
}

void Machine::time_out() {
  if (waiting_) timed_out_ = true;
}

const Value* Machine::variable(std::string_view name) const {
  for (VariableId id = 0; id < program_->variables.size(); ++id) {
    if (program_->variables[id].name == name) return &values_[first_value_[id]];
  }
  return nullptr;
}

}  // namespace cellmirror::program
