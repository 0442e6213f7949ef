#include "config/sparkplug_names.hpp"

#include <fmt/format.h>

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "rt_core/base/text.hpp"
#include "rt_core/cell/compiled_cell.hpp"

namespace cellmirror {

namespace {

// The first two names that are the same but for case.
std::optional<std::pair<std::string, std::string>> same_but_case(const std::vector<std::string>& names) {
  std::map<std::string, std::string> seen;
  for (const std::string& name : names) {
    const auto [at, is_new] = seen.emplace(lower_case(name), name);
    if (!is_new) return std::pair(at->second, name);
  }
  return std::nullopt;
}

}  // namespace

void check_sparkplug_names(const Cell& cell, const MqttConfig& mqtt, const Place& file, Diagnostics& diagnostics) {
  if (!mqtt.enabled || !mqtt.sparkplug) return;
  if (const auto robots = same_but_case(cell.robot_ids()))
    diagnostics.error(
        file,
        fmt::format("the robots {} and {} differ by case only: hosts of Sparkplug take them for one device",
                    printable(robots->first), printable(robots->second)),
        "rename one of them, or remove sparkplug from [mqtt]");
  if (mqtt.joint_states_hz <= 0) return;
  for (const CompiledRobot& robot : cell.compile()->robots) {
    if (const auto joints = same_but_case(robot.joint_names))
      diagnostics.error(
          file,
          fmt::format("the joints {} and {} of {} differ by case only: hosts of Sparkplug take them for one metric",
                      printable(joints->first), printable(joints->second), printable(robot.id)),
          "rename one of them, or set joint_states_hz = 0 in [mqtt]");
  }
}

}  // namespace cellmirror
