// Expressions of the machine: what variables and the world say; operators are in operators.cpp.
#include <fmt/format.h>

#include <utility>

#include "scripts/programs/program/machine.hpp"

namespace cellmirror::program {
namespace {

Result<std::size_t> port_number(const Value* operand) {
  const auto* number = operand == nullptr ? nullptr : std::get_if<std::int64_t>(operand);
  if (number == nullptr) return fail("the number of an input or output is a whole number");
  if (*number < 1 || *number > static_cast<std::int64_t>(kMostPorts)) {
    return fail(fmt::format("input or output {}: they are numbered 1 to {}", *number, kMostPorts));
  }
  return static_cast<std::size_t>(*number);
}

}  // namespace

Result<std::size_t> Machine::value_place(VariableId variable, const Value* index) const {
  const Variable& declared = program_->variables[variable];
  if (index == nullptr) return first_value_[variable];
  const auto* number = std::get_if<std::int64_t>(index);
  if (number == nullptr) return fail(fmt::format("the index of '{}' is not a whole number", declared.name));
  const auto size = static_cast<std::int64_t>(declared.initial.size());
  // Written so that no index overflows.
  if (*number < declared.first || *number - declared.first >= size) {
    return fail(fmt::format("'{}' has elements {} to {}, not {}", declared.name, declared.first,
                            declared.first + size - 1, *number));
  }
  return first_value_[variable] + static_cast<std::size_t>(*number - declared.first);
}

Result<Value> Machine::element(const ExpressionNode& node, const Value& index) const {
  const auto place = value_place(node.payload, &index);
  if (!place) return std::unexpected(place.error());
  return values_[*place];
}

Result<Value> Machine::look(const ProgramWorld& world, const ExpressionNode& node, const Value* operand) const {
  if (node.which == Operator::current_joints) {
    return joint_position(world.joints(), joints_, joint_units(node.payload));
  }
  if (node.which == Operator::current_position) {
    const auto X_ZT = world.position();
    if (!X_ZT) return std::unexpected(X_ZT.error());
    return X_ZU_.inverse() * *X_ZT;
  }
  const auto number = port_number(operand);
  if (!number) return std::unexpected(number.error());
  if (node.which == Operator::digital_input) return world.digital_input(*number);
  if (node.which == Operator::analogue_input) return world.analogue_input(*number);
  if (node.which == Operator::digital_output) return world.digital_output(*number);
  return world.analogue_output(*number);
}

// Leaves the values of the operands on the stack.
Result<void> Machine::evaluate_operands(const ProgramWorld& world, const ExpressionNode& node) {
  for (std::size_t index = 0; index < node.operands; ++index) {
    const ExpressionId operand = program_->operands[node.first_operand + index];
    if (auto done = evaluate_node(world, program_->expressions[operand]); !done) return done;
  }
  return {};
}

// Puts the value on the stack. Recursion is bounded by kMostExpressionDepth.
Result<void> Machine::evaluate_node(const ProgramWorld& world, const ExpressionNode& node) {
  if (node.which == Operator::constant) {
    stack_.push_back(program_->constants[node.payload]);
    return {};
  }
  if (node.which == Operator::variable) {
    stack_.push_back(values_[first_value_[node.payload]]);
    return {};
  }
  const std::size_t base = stack_.size();
  if (auto done = evaluate_operands(world, node); !done) return done;
  const std::span<const Value> operands = std::span<const Value>(stack_).subspan(base);
  auto value = node.which == Operator::element ? element(node, operands[0])
               : reads_world(node.which)       ? look(world, node, operands.empty() ? nullptr : &operands[0])
                                               : apply(node.which, operands, node.payload);
  if (!value) return std::unexpected(value.error());
  stack_.resize(base);
  stack_.push_back(std::move(*value));
  return {};
}

Result<Value> Machine::evaluate(const ProgramWorld& world, ExpressionId id) {
  stack_.clear();
  if (auto done = evaluate_node(world, program_->expressions[id]); !done) return std::unexpected(done.error());
  return std::move(stack_.back());
}

Result<double> Machine::evaluate_number(const ProgramWorld& world, ExpressionId id) {
  const auto value = evaluate(world, id);
  if (!value) return std::unexpected(value.error());
  if (const auto* real = std::get_if<double>(&*value)) return *real;
  if (const auto* integer = std::get_if<std::int64_t>(&*value)) return static_cast<double>(*integer);
  return fail(fmt::format("{} where a number is needed", name_of(type_of(*value))));
}

// In SI, and out of the program's zero point.
Result<Target> Machine::evaluate_target(const ProgramWorld& world, TargetKind kind, ExpressionId id) {
  const auto value = evaluate(world, id);
  if (!value) return std::unexpected(value.error());
  Target target;
  target.kind = kind;
  if (const auto* joints = std::get_if<JointPosition>(&*value)) {
    const auto values = joint_values_si(*joints, joints_);
    if (!values) return std::unexpected(values.error());
    target.joints = *values;
    target.joint_count = joints->count;
    return target;
  }
  const auto* X = std::get_if<Pose>(&*value);
  if (X == nullptr) return fail(fmt::format("{} where a target is needed", name_of(type_of(*value))));
  target.pose = *X;
  if (kind == TargetKind::pose_absolute) target.pose = X_ZU_ * *X;
  if (kind == TargetKind::pose_relative) {
    const Eigen::Matrix3d R_ZU = X_ZU_.linear();
    target.pose.linear() = R_ZU * X->linear() * R_ZU.transpose();
    target.pose.translation() = R_ZU * X->translation();
  }
  if (!target.pose.matrix().allFinite()) return fail("the target is not finite");
  return target;
}

}  // namespace cellmirror::program
