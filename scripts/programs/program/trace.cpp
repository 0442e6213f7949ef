#include "scripts/programs/program/trace.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>

#include "scripts/programs/program/program.hpp"

namespace cellmirror::program {
namespace {

std::string number(double value) {
  std::string text = fmt::format("{:.6f}", value);
  return text == "-0.000000" ? text.substr(1) : text;
}

void add_number(std::string& out, double value) { out += " " + number(value); }

// A rotation has two quaternions: the one with qw >= 0, or, for half a turn, whose first component that is not 0 is
// positive.
void add_pose(std::string& out, const Pose& X) {
  for (const double length : X.translation()) add_number(out, length);
  const Eigen::Quaterniond rotation(X.linear());
  std::array<double, 4> q = {rotation.x(), rotation.y(), rotation.z(), rotation.w()};
  constexpr double kShownAsZero = 0.5e-6;
  double sign_of = q[3];
  for (std::size_t index = 0; std::abs(sign_of) < kShownAsZero && index < 3; ++index) sign_of = q.at(index);
  for (const double component : q) add_number(out, sign_of < 0 ? -component : component);
}

void add_target(std::string& out, const Target& target) {
  switch (target.kind) {
    case TargetKind::joints_absolute:
    case TargetKind::joints_relative:
      out += target.kind == TargetKind::joints_absolute ? "joints" : "joints+";
      for (std::size_t joint = 0; joint < target.joint_count; ++joint) add_number(out, target.joints[joint]);
      return;
    case TargetKind::pose_absolute:
      out += "pose";
      break;
    case TargetKind::pose_relative:
      out += "pose+";
      break;
    case TargetKind::tool_relative:
      out += "tool+";
      break;
  }
  add_pose(out, target.pose);
}

std::string settings_text(const MotionSettings& settings) {
  std::string out;
  const auto add = [&](std::string_view name, const std::optional<double>& value) {
    if (value) out += fmt::format(" {} {}", name, number(*value));
  };
  add("joint_velocity", settings.joint_velocity);
  add("joint_acceleration", settings.joint_acceleration);
  add("linear_velocity", settings.linear_velocity);
  add("linear_acceleration", settings.linear_acceleration);
  add("rotational_velocity", settings.rotational_velocity);
  add("rotational_acceleration", settings.rotational_acceleration);
  add("linear_velocity_share", settings.linear_velocity_share);
  add("linear_acceleration_share", settings.linear_acceleration_share);
  add("rotational_velocity_share", settings.rotational_velocity_share);
  add("rotational_acceleration_share", settings.rotational_acceleration_share);
  if (settings.fly_type) {
    constexpr std::array<std::string_view, 3> kNames = {"fly_speed_fraction", "fly_distance", "fly_angle"};
    add(kNames.at(static_cast<std::size_t>(*settings.fly_type)), settings.fly_parameter);
  }
  return out.empty() ? out : " with" + out;
}

struct Text {
  std::string operator()(const MoveCommand& move) const {
    constexpr std::array<std::string_view, 3> kPaths = {"ptp", "linear", "circular"};
    std::string out = fmt::format("move {} ", kPaths.at(static_cast<std::size_t>(move.path)));
    if (move.via) {
      out += "via ";
      add_target(out, *move.via);
      out += " ";
    }
    out += "to ";
    add_target(out, move.target);
    if (move.fly) out += " fly";
    return out + settings_text(move.settings);
  }
  std::string operator()(const DelayCommand& delay) const { return "delay " + number(delay.seconds); }
  std::string operator()(const ToolCommand& tool) const {
    if (!tool.X_PT) return "tool of the robot";
    std::string out = "tool";
    add_pose(out, *tool.X_PT);
    return out;
  }
  std::string operator()(const OutputCommand& output) const {
    if (output.analogue) return fmt::format("output analogue {} {}", output.number, number(output.value));
    return fmt::format("output {} {}", output.number, output.value != 0 ? "on" : "off");
  }
  std::string operator()(const WaitCommand& wait) const {
    return fmt::format("wait {}{}", wait.condition, wait.timeout_s ? ", at most " + number(*wait.timeout_s) : "");
  }
  std::string operator()(const AcquireCommand& acquire) const { return "acquire " + acquire.semaphore; }
  std::string operator()(const ReleaseCommand& release) const { return "release " + release.semaphore; }
  std::string operator()(const ScriptCommand& script) const { return "script " + script.text; }
  std::string operator()(const PauseCommand& /*pause*/) const { return "pause"; }
  std::string operator()(const RestCommand& /*rest*/) const { return "rest"; }
};

}  // namespace

std::string trace_line(const Program& program, const CanonicalCommand& command) {
  return fmt::format("{} {}", program.place(command.statement).line, std::visit(Text{}, command.what));
}

}  // namespace cellmirror::program
