// What the machine does with each kind of statement.
#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "scripts/programs/program/describe.hpp"
#include "scripts/programs/program/machine.hpp"
#include "scripts/programs/program/program_check.hpp"

namespace cellmirror::program {

struct Machine::Execute {
  Machine& machine;
  const ProgramWorld& world;
  using Next = Result<Outcome>;

  Next give(auto command) const {
    machine.command_.statement = machine.position_;
    machine.command_.what = std::move(command);
    ++machine.position_;
    return Outcome::command;
  }
  [[nodiscard]] Next go_on() const {
    ++machine.position_;
    return Outcome::go_on;
  }
  [[nodiscard]] Result<double> time(ExpressionId id, std::string_view what) const {
    auto seconds = machine.evaluate_number(world, id);
    if (seconds && !(*seconds >= 0 && *seconds <= kLongestTime_s)) {
      return fail(fmt::format("{} is {} s: it must be within 0 .. {} s", what, *seconds, kLongestTime_s));
    }
    return seconds;
  }

  Next operator()(const MoveStatement& statement) const {
    MoveCommand move;
    move.path = statement.path;
    move.fly = statement.fly;
    move.settings = machine.settings_;
    auto target = machine.evaluate_target(world, statement.kind, statement.target);
    if (!target) return std::unexpected(target.error());
    move.target = *target;
    if (statement.path == PathKind::circular) {
      auto via = machine.evaluate_target(world, statement.kind, statement.via);
      if (!via) return std::unexpected(via.error());
      move.via = *via;
    }
    machine.rested_ = false;
    return give(std::move(move));
  }

  Next operator()(const AssignStatement& assign) const {
    std::optional<Value> index;
    if (assign.index != kNoExpression) {
      auto evaluated = machine.evaluate(world, assign.index);
      if (!evaluated) return std::unexpected(evaluated.error());
      index = std::move(*evaluated);
    }
    auto value = machine.evaluate(world, assign.value);
    if (!value) return std::unexpected(value.error());
    const auto place = machine.value_place(assign.variable, index ? &*index : nullptr);
    if (!place) return std::unexpected(place.error());
    Value& slot = machine.values_[*place];
    if (assign.component != kNone) {
      if (auto done = assign_component(slot, assign.component, *value); !done) return std::unexpected(done.error());
      return go_on();
    }
    const auto* integer = std::get_if<std::int64_t>(&*value);
    const bool widened = integer != nullptr && std::holds_alternative<double>(slot);
    slot = widened ? Value(static_cast<double>(*integer)) : std::move(*value);
    return go_on();
  }

  static Result<void> assign_component(Value& slot, std::uint32_t component, const Value& value) {
    const auto* integer = std::get_if<std::int64_t>(&value);
    const auto* real = std::get_if<double>(&value);
    if (integer == nullptr && real == nullptr) return fail("the value of a component is a number");
    const double number = integer != nullptr ? static_cast<double>(*integer) : *real;
    if (auto* joints = std::get_if<JointPosition>(&slot)) {
      if (component >= joints->count) return fail(fmt::format("joint {} of {}", component + 1, joints->count));
      joints->values[component] = number;
      return {};
    }
    auto& X = std::get<Pose>(slot);
    if (component < 3) {
      X.translation()[component] = number;
      return {};
    }
    Eigen::Vector3d rpy = rpy_from_rotation(X.linear());
    rpy[component - 3] = number;
    X.linear() = rotation_from_rpy(rpy.x(), rpy.y(), rpy.z());
    return {};
  }

  Next operator()(const JumpStatement& jump) const {
    machine.position_ = jump.target;
    return Outcome::go_on;
  }
  Next operator()(const BranchStatement& branch) const {
    const auto condition = machine.evaluate(world, branch.condition);
    if (!condition) return std::unexpected(condition.error());
    if (std::get<bool>(*condition)) return go_on();
    machine.position_ = branch.target;
    return Outcome::go_on;
  }
  Next operator()(const CallStatement& call) const {
    if (machine.calls_.size() >= kMostCalls) {
      return fail(fmt::format("more than {} nested subprograms", kMostCalls),
                  "a subprogram that calls itself needs a condition that ends it");
    }
    machine.calls_.push_back(machine.position_ + 1);
    machine.position_ = call.target;
    return Outcome::go_on;
  }
  Next operator()(const ReturnStatement& /*statement*/) const {
    if (machine.calls_.empty()) return fail("a return outside a subprogram");
    machine.position_ = machine.calls_.back();
    machine.calls_.pop_back();
    return Outcome::go_on;
  }
  Next operator()(const EndStatement& /*statement*/) const {
    machine.position_ = static_cast<StatementId>(machine.program_->statements.size());
    return Outcome::ended;
  }
  Next operator()(const PauseStatement& /*statement*/) const { return give(PauseCommand{}); }
  Next operator()(const DelayStatement& delay) const {
    const auto seconds = time(delay.seconds, "the time to wait");
    if (!seconds) return std::unexpected(seconds.error());
    machine.rested_ = false;
    return give(DelayCommand{*seconds});
  }
  Next operator()(const WaitStatement& wait) const {
    WaitCommand command;
    if (wait.timeout_s != kNoExpression) {
      const auto seconds = time(wait.timeout_s, "the time limit");
      if (!seconds) return std::unexpected(seconds.error());
      command.timeout_s = *seconds;
    }
    const Program& program = *machine.program_;
    command.condition = wait.text == kNone ? describe(program, wait.condition) : program.texts[wait.text];
    machine.waiting_ = machine.position_;
    machine.timed_out_ = false;
    return give(std::move(command));
  }
  Next operator()(const OutputStatement& output) const {
    const auto number = machine.evaluate(world, output.number);
    if (!number) return std::unexpected(number.error());
    const auto port = std::get<std::int64_t>(*number);
    if (port < 1 || port > static_cast<std::int64_t>(kMostPorts)) {
      return fail(fmt::format("output {}: there are outputs 1 to {}", port, kMostPorts));
    }
    const auto value = machine.evaluate(world, output.value);
    if (!value) return std::unexpected(value.error());
    OutputCommand command{.analogue = output.analogue, .number = static_cast<std::uint16_t>(port)};
    if (const auto* on = std::get_if<bool>(&*value)) command.value = *on ? 1 : 0;
    if (const auto* real = std::get_if<double>(&*value)) command.value = *real;
    if (const auto* integer = std::get_if<std::int64_t>(&*value)) command.value = static_cast<double>(*integer);
    return give(command);
  }
  Next operator()(const SemaphoreStatement& semaphore) const {
    const std::string& name = machine.program_->texts[semaphore.name];
    return semaphore.acquire ? give(AcquireCommand{name}) : give(ReleaseCommand{name});
  }
  Next operator()(const ScriptStatement& script) const {
    return give(ScriptCommand{machine.program_->texts[script.text]});
  }
  Next operator()(const SetStatement& set) const {
    if (set.setting == Setting::tool || set.setting == Setting::zero_point) return set_frame(set);
    std::optional<double> value;
    if (set.value != kNoExpression) {
      const auto evaluated = machine.evaluate_number(world, set.value);
      if (!evaluated) return std::unexpected(evaluated.error());
      value = *evaluated;
    }
    if (auto done = machine.apply_setting(set.setting, value); !done) return std::unexpected(done.error());
    return go_on();
  }

  [[nodiscard]] Next set_frame(const SetStatement& set) const {
    std::optional<Pose> X;
    if (set.value != kNoExpression) {
      const auto evaluated = machine.evaluate(world, set.value);
      if (!evaluated) return std::unexpected(evaluated.error());
      X = std::get<Pose>(*evaluated);
    }
    if (set.setting == Setting::tool) return give(ToolCommand{X});
    machine.X_ZU_ = X.value_or(Pose::Identity());
    return go_on();
  }
};

Result<void> Machine::apply_setting(Setting setting, std::optional<double> value) {
  if (value) {
    if (auto checked = check_setting(setting, *value); !checked) return checked;
  }
  const auto set_fly = [&](FlyType type) {
    settings_.fly_type = value ? std::optional(type) : std::nullopt;
    settings_.fly_parameter = value.value_or(0);
  };
  const auto set_either = [&](Setting absolute, std::optional<double>& itself, std::optional<double>& share) {
    itself = setting == absolute ? value : std::nullopt;
    share = setting == absolute ? std::nullopt : value;
  };
  switch (setting) {
    case Setting::joint_velocity:
      settings_.joint_velocity = value;
      break;
    case Setting::joint_acceleration:
      settings_.joint_acceleration = value;
      break;
    case Setting::linear_velocity:
    case Setting::linear_velocity_share:
      set_either(Setting::linear_velocity, settings_.linear_velocity, settings_.linear_velocity_share);
      break;
    case Setting::linear_acceleration:
    case Setting::linear_acceleration_share:
      set_either(Setting::linear_acceleration, settings_.linear_acceleration, settings_.linear_acceleration_share);
      break;
    case Setting::rotational_velocity:
    case Setting::rotational_velocity_share:
      set_either(Setting::rotational_velocity, settings_.rotational_velocity, settings_.rotational_velocity_share);
      break;
    case Setting::rotational_acceleration:
    case Setting::rotational_acceleration_share:
      set_either(Setting::rotational_acceleration, settings_.rotational_acceleration,
                 settings_.rotational_acceleration_share);
      break;
    case Setting::fly_speed_fraction:
      set_fly(FlyType::speed_fraction);
      break;
    case Setting::fly_distance:
      set_fly(FlyType::distance);
      break;
    case Setting::fly_angle:
      set_fly(FlyType::angle);
      break;
    case Setting::tool:
    case Setting::zero_point:
      break;
  }
  return {};
}

Machine::Outcome Machine::execute(const ProgramWorld& world) {
  const StatementId statement = position_;
  const auto outcome = std::visit(Execute{*this, world}, program_->statements[statement]);
  if (outcome) return *outcome;
  failed(statement, outcome.error());
  return Outcome::failed;
}

}  // namespace cellmirror::program
