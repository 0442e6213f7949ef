#include "app/subcommands/check_program_fit.hpp"

#include <fmt/format.h>

#include <optional>
#include <span>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "rt_core/base/units.hpp"
#include "scripts/programs/program/program_check.hpp"

namespace cellmirror::app {

using program::Program;
using program::StatementId;

namespace {

// Values that a run cannot change.
class Constants {
 public:
  explicit Constants(const Program& program) : program_(program), changed_(program.variables.size(), false) {
    for (const program::Statement& statement : program.statements) {
      const auto* assign = std::get_if<program::AssignStatement>(&statement);
      if (assign != nullptr && assign->variable < changed_.size()) changed_[assign->variable] = true;
    }
  }

  // Null where the value shows only in a run. A variable that nothing is assigned to keeps its first value.
  [[nodiscard]] const program::Value* find(program::ExpressionId id) const {
    if (id >= program_.expressions.size()) return nullptr;
    const program::ExpressionNode& node = program_.expressions[id];
    if (node.which != program::Operator::variable) return program::constant_value(program_, id);
    if (node.payload >= changed_.size() || changed_[node.payload]) return nullptr;
    const program::Variable& variable = program_.variables[node.payload];
    return variable.list || variable.initial.empty() ? nullptr : &variable.initial.front();
  }

 private:
  const Program& program_;
  std::vector<bool> changed_;
};

struct Bound {
  double most;      // SI
  double per_unit;  // SI
  const char* unit;
  const char* parameter;
};

std::optional<Bound> bound_of(program::Setting setting, const RobotParameters& robot) {
  switch (setting) {
    case program::Setting::linear_velocity:
      return Bound{robot.linear_velocity, kMPerMm, "mm/s", "rob_cart_lin_vel"};
    case program::Setting::linear_acceleration:
      return Bound{robot.linear_acceleration, kMPerMm, "mm/s2", "rob_cart_lin_acc"};
    case program::Setting::rotational_velocity:
      return Bound{robot.rotational_velocity, kRadPerDeg, "degrees/s", "rob_cart_rot_vel"};
    case program::Setting::rotational_acceleration:
      return Bound{robot.rotational_acceleration, kRadPerDeg, "degrees/s2", "rob_cart_rot_acc"};
    default:
      return std::nullopt;
  }
}

class Fit {
 public:
  Fit(const Program& program, const RobotModel& robot, Diagnostics& diagnostics)
      : program_(program), robot_(robot), diagnostics_(diagnostics), constants_(program) {}

  void check() {
    for (StatementId id = 0; id < program_.statements.size(); ++id) {
      const program::Statement& statement = program_.statements[id];
      if (const auto* move = std::get_if<program::MoveStatement>(&statement)) check(*move, program_.place(id));
      if (const auto* set = std::get_if<program::SetStatement>(&statement)) check(*set, program_.place(id));
    }
  }

 private:
  void check(const program::MoveStatement& move, const Place& place) {
    if (move.kind != program::TargetKind::joints_absolute) return;
    for (const program::ExpressionId target : {move.via, move.target}) {
      const program::Value* value = constants_.find(target);
      const auto* joints = value == nullptr ? nullptr : std::get_if<program::JointPosition>(value);
      if (joints == nullptr) continue;
      const auto values = program::joint_values_si(*joints, robot_.joint_kinds());
      if (!values) continue;  // too many of them, which is reported
      check_joint_values(robot_, std::span(*values).first(joints->count), [&](std::size_t, const Error& why) {
        diagnostics_.warning(place, why.what, "the program fails there");
      });
    }
  }

  void check(const program::SetStatement& set, const Place& place) {
    const auto bound = bound_of(set.setting, robot_.parameters());
    const program::Value* value = bound ? constants_.find(set.value) : nullptr;
    const auto* wanted = value == nullptr ? nullptr : std::get_if<double>(value);
    if (wanted == nullptr || *wanted <= bound->most) return;
    diagnostics_.add(
        {Severity::note, place,
         fmt::format("{} is {:g} {}, but {} goes at {:g} {} at most", program::name_of(set.setting),
                     *wanted / bound->per_unit, bound->unit, robot_.id(), bound->most / bound->per_unit, bound->unit),
         fmt::format("moves keep to that; {} sets it", bound->parameter)});
  }

  const Program& program_;
  const RobotModel& robot_;
  Diagnostics& diagnostics_;
  Constants constants_;
};

bool waits_for_programs(script::FormId id) { return id == script::FormId::wait || id == script::FormId::tf_wait; }

}  // namespace

void check_program_comments(const Program& program, const LoadedCell* cell, const NameDirectory* names,
                            Diagnostics& diagnostics) {
  Diagnostics found;  // of one comment: its places are within the comment
  std::optional<CommandChecks> checks;
  if (cell != nullptr && names != nullptr) checks.emplace(*cell, *names, found);
  script::ScriptChecker checker(names, [&](const script::ParsedCommand& command, const PlaceOf& place_of) {
    if (waits_for_programs(command.id()))
      found.error({}, fmt::format("{} is refused in a robot program, which would wait for itself", command.form().name),
                  "leave it out: a comment is executed when the moves before it have ended");
    if (checks) checks->follow(command, place_of);
  });
  for (StatementId id = 0; id < program.statements.size(); ++id) {
    const auto* comment = std::get_if<program::ScriptStatement>(&program.statements[id]);
    if (comment == nullptr || comment->text >= program.texts.size()) continue;
    checker.check(program.texts[comment->text], program.file, script::TextKind::message, found);
    for (const Diagnostic& finding : found.all())
      diagnostics.add({finding.severity, program.place(id), finding.message, finding.remedy});
    found = {};
  }
}

void check_program_fit(const Program& program, const RobotModel& robot, Diagnostics& diagnostics) {
  program.check_for(robot.joint_kinds(), diagnostics);
  Fit(program, robot, diagnostics).check();
}

}  // namespace cellmirror::app
