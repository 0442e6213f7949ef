#include "app/report/implausible_values.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace cellmirror::app {

std::string implausible_text(const ImplausibleValue& found, const RobotState& robot) {
  if (found.joint >= robot.joints.size()) return {};
  const RobotJointState& joint = robot.joints[found.joint];
  const char* unit = joint.kind == JointKind::prismatic ? "m" : "rad";
  switch (found.why) {
    case Implausibility::none:
      return {};
    case Implausibility::position:
      return fmt::format("{} is at {:.6g} {}, beyond {:.6g} {}", joint.name, found.value, unit, found.bound, unit);
    case Implausibility::velocity:
      return fmt::format("{} moves at {:.3g} {}/s, beyond {:.3g} {}/s", joint.name, found.value, unit, found.bound,
                         unit);
    case Implausibility::acceleration:
      return fmt::format("{} accelerates by {:.3g} {}/s2, beyond {:.3g} {}/s2", joint.name, found.value, unit,
                         found.bound, unit);
    case Implausibility::frozen:
      return fmt::format("{} is the same to the last bit for {:.1f} s", joint.name, found.value);
  }
  return {};
}

std::string condition_text(const engine::RobotTickHead& tick, const RobotState& robot, const std::string& of_stream) {
  const bool implausible = std::ranges::any_of(
      robot.joints, [](const RobotJointState& joint) { return joint.state == DataState::implausible; });
  if (!implausible) return of_stream;
  const std::string text = "implausible: " + implausible_text(tick.newest_implausible, robot);
  return of_stream.empty() || of_stream == "operational" ? text : text + "; " + of_stream;
}

}  // namespace cellmirror::app
