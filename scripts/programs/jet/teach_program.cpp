#include "scripts/programs/jet/teach_program.hpp"

#include <string>

namespace cellmirror::program {

namespace {

Setting setting_of(FlyType type) {
  switch (type) {
    case FlyType::speed_fraction:
      return Setting::fly_speed_fraction;
    case FlyType::distance:
      return Setting::fly_distance;
    case FlyType::angle:
      break;
  }
  return Setting::fly_angle;
}

}  // namespace

TeachProgram::TeachProgram(TeachDialect dialect, std::string_view file)
    : builder_(name_of_file(file), language_of(dialect), std::string(file)) {
  builder_.set_reversible();
}

void TeachProgram::at(int line, int column) {
  line_ = static_cast<std::uint32_t>(line);
  column_ = static_cast<std::uint32_t>(column);
  builder_.at(line_, column_);
}

Result<void> TeachProgram::set(Setting setting, const std::optional<double>& value, std::optional<double>& in_force) {
  if (value == in_force) return {};
  in_force = value;
  return builder_.add(SetStatement{setting, value ? builder_.real(*value) : kNoExpression});
}

Result<void> TeachProgram::set(const TeachTolerance& tolerance) {
  if (in_force_.tolerance == tolerance) return {};
  in_force_.tolerance = tolerance;
  return builder_.add(SetStatement{setting_of(tolerance.type), builder_.real(tolerance.parameter)});
}

Result<void> TeachProgram::point(std::string_view name, const JointPosition& target, const TeachSettings& settings) {
  label_ = "check point ";
  label_ += name;
  builder_.at(line_, column_, label_);
  if (auto done = set(Setting::joint_velocity, settings.speed, in_force_.speed); !done) return done;
  if (auto done = set(Setting::joint_acceleration, settings.acceleration, in_force_.acceleration); !done) return done;
  if (settings.tolerance) {
    if (auto done = set(*settings.tolerance); !done) return done;
  }
  MoveStatement move;
  move.path = PathKind::joints;
  move.kind = TargetKind::joints_absolute;
  move.fly = settings.tolerance.has_value();
  move.target = builder_.constant(target);
  return builder_.add(move);
}

Result<void> TeachProgram::dwell(double seconds) { return builder_.add(DelayStatement{builder_.real(seconds)}); }

Result<void> TeachProgram::output(std::uint16_t number, bool on) {
  OutputStatement output;
  output.number = builder_.integer(number);
  output.value = builder_.boolean(on);
  return builder_.add(output);
}

}  // namespace cellmirror::program
