#include "scripts/programs/program/program_check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

namespace cellmirror::program {
namespace {

bool is_number(ValueType type) { return type == ValueType::integer || type == ValueType::real; }

struct Checker {
  const Program& program;
  std::span<const ValueType> types;

  [[nodiscard]] bool given(ExpressionId id) const { return id < types.size(); }

  Result<void> number(ExpressionId id, std::string_view what) const {
    if (!given(id)) return fail(fmt::format("{} is missing", what));
    if (!is_number(types[id])) return fail(fmt::format("{} is a number, not {}", what, name_of(types[id])));
    return {};
  }
  Result<void> of_type(ExpressionId id, ValueType type, std::string_view what) const {
    if (!given(id)) return fail(fmt::format("{} is missing", what));
    if (types[id] != type) {
      return fail(fmt::format("{} is {}, not {}", what, name_of(type), name_of(types[id])));
    }
    return {};
  }
  Result<void> time(ExpressionId id, std::string_view what) const {
    if (auto checked = number(id, what); !checked) return checked;
    const auto value = constant_number(program, id);
    if (value && !(*value >= 0 && *value <= kLongestTime_s)) {
      return fail(fmt::format("{} is {} s: it must be within 0 .. {} s", what, *value, kLongestTime_s));
    }
    return {};
  }

  Result<void> operator()(const MoveStatement& move) const {
    const bool joints = move.kind == TargetKind::joints_absolute || move.kind == TargetKind::joints_relative;
    const ValueType type = joints ? ValueType::joints : ValueType::pose;
    if (auto checked = of_type(move.target, type, "the target of the move"); !checked) return checked;
    if (move.path != PathKind::circular) return {};
    return of_type(move.via, type, "the via point of the move");
  }
  Result<void> operator()(const AssignStatement& assign) const {
    if (assign.variable >= program.variables.size()) return fail("there is no such variable");
    const Variable& variable = program.variables[assign.variable];
    if (variable.list) {
      if (auto checked = of_type(assign.index, ValueType::integer, "the index of '" + variable.name + "'"); !checked) {
        return checked;
      }
    } else if (assign.index != kNoExpression) {
      return fail(fmt::format("'{}' is not a list", variable.name));
    }
    if (assign.component != kNone) {
      const bool pose = variable.type == ValueType::pose;
      if (!pose && variable.type != ValueType::joints) {
        return fail(fmt::format("'{}' is {} and has no components", variable.name, name_of(variable.type)));
      }
      if (assign.component >= (pose ? 6 : kMaxJointsPerRobot)) return fail("there is no such component");
      return number(assign.value, "the value of a component");
    }
    if (variable.type == ValueType::real) return number(assign.value, "the value of '" + variable.name + "'");
    return of_type(assign.value, variable.type, "the value of '" + variable.name + "'");
  }
  Result<void> operator()(const JumpStatement& /*jump*/) const { return {}; }
  Result<void> operator()(const BranchStatement& branch) const {
    return of_type(branch.condition, ValueType::boolean, "the condition");
  }
  Result<void> operator()(const CallStatement& /*call*/) const { return {}; }
  Result<void> operator()(const ReturnStatement& /*statement*/) const { return {}; }
  Result<void> operator()(const EndStatement& /*statement*/) const { return {}; }
  Result<void> operator()(const PauseStatement& /*statement*/) const { return {}; }
  Result<void> operator()(const DelayStatement& delay) const { return time(delay.seconds, "the time to wait"); }
  Result<void> operator()(const WaitStatement& wait) const {
    if (auto checked = of_type(wait.condition, ValueType::boolean, "the condition"); !checked) return checked;
    if (wait.timed_out != kNone) {
      if (wait.timeout_s == kNoExpression) return fail("a timeout result needs a time limit");
      const bool fits = wait.timed_out < program.variables.size() && !program.variables[wait.timed_out].list &&
                        program.variables[wait.timed_out].type == ValueType::boolean;
      if (!fits) return fail("the timeout result needs a boolean variable");
    }
    return wait.timeout_s == kNoExpression ? Result<void>{} : time(wait.timeout_s, "the time limit");
  }
  Result<void> operator()(const OutputStatement& output) const {
    if (auto checked = of_type(output.number, ValueType::integer, "the number of the output"); !checked) return checked;
    const auto port = constant_number(program, output.number);
    if (port && !(*port >= 1 && *port <= static_cast<double>(kMostPorts))) {
      return fail(fmt::format("output {}: there are outputs 1 to {}", *port, kMostPorts));
    }
    if (output.analogue) return number(output.value, "the value of an analogue output");
    return of_type(output.value, ValueType::boolean, "the value of a digital output");
  }
  Result<void> operator()(const SemaphoreStatement& semaphore) const {
    if (semaphore.name >= program.texts.size() || program.texts[semaphore.name].empty()) {
      return fail("the name of the semaphore is missing");
    }
    return {};
  }
  Result<void> operator()(const ScriptStatement& script) const {
    if (script.text >= program.texts.size() || program.texts[script.text].empty()) {
      return fail("the SCRIPT command is missing");
    }
    return {};
  }
  Result<void> operator()(const SetStatement& set) const {
    if (set.value == kNoExpression) return {};
    if (set.setting == Setting::tool || set.setting == Setting::zero_point) {
      return of_type(set.value, ValueType::pose, name_of(set.setting));
    }
    if (auto checked = number(set.value, name_of(set.setting)); !checked) return checked;
    const auto value = constant_number(program, set.value);
    return value ? check_setting(set.setting, *value) : Result<void>{};
  }
};

}  // namespace

std::string_view name_of(Setting setting) {
  constexpr std::array<std::string_view, 15> kNames = {"the joint velocity",      "the joint acceleration",
                                                       "the linear velocity",     "the linear acceleration",
                                                       "the rotational velocity", "the rotational acceleration",
                                                       "the linear velocity",     "the linear acceleration",
                                                       "the rotational velocity", "the rotational acceleration",
                                                       "the fly-by speed",        "the fly-by distance",
                                                       "the fly-by angle",        "the tool",
                                                       "the zero point"};
  return kNames.at(static_cast<std::size_t>(setting));
}

Result<void> check_setting(Setting setting, double value) {
  const bool share = setting == Setting::joint_velocity || setting == Setting::joint_acceleration ||
                     (setting >= Setting::linear_velocity_share && setting <= Setting::fly_speed_fraction);
  const bool may_be_zero =
      setting == Setting::fly_speed_fraction || setting == Setting::fly_distance || setting == Setting::fly_angle;
  const bool large_enough = may_be_zero ? value >= 0 : value > 0;
  if (std::isfinite(value) && large_enough && (!share || value <= 1)) return {};
  if (share) {
    return fail(fmt::format("{} is {} %: it must be {} 0 and at most 100 %", name_of(setting), value * 100,
                            may_be_zero ? "at least" : "above"));
  }
  return fail(fmt::format("{} is {}: it must be {} 0", name_of(setting), value, may_be_zero ? "at least" : "above"));
}

const Value* constant_value(const Program& program, ExpressionId id) {
  if (id >= program.expressions.size()) return nullptr;
  const ExpressionNode& node = program.expressions[id];
  return node.which == Operator::constant ? &program.constants[node.payload] : nullptr;
}

std::optional<double> constant_number(const Program& program, ExpressionId id) {
  const Value* value = constant_value(program, id);
  if (value == nullptr) return std::nullopt;
  if (const auto* real = std::get_if<double>(value)) return *real;
  if (const auto* integer = std::get_if<std::int64_t>(value)) return static_cast<double>(*integer);
  return std::nullopt;
}

Result<void> check_statement(const Program& program, std::span<const ValueType> types, const Statement& statement) {
  return std::visit(Checker{program, types}, statement);
}

}  // namespace cellmirror::program
