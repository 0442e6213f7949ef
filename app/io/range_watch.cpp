#include "app/io/range_watch.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>

#include "rt_core/base/units.hpp"

namespace cellmirror::app {

namespace {

constexpr Nanoseconds kToldAgainAfter = std::chrono::seconds(10);

std::string beyond_text(const std::string& robot, const RobotJointState& joint, double lower, double upper) {
  const bool prismatic = joint.kind == JointKind::prismatic;
  const auto shown = [prismatic](double value) { return prismatic ? mm_from_m(value) : deg_from_rad(value); };
  return fmt::format(
      "{} of {} is at {:.2f} {unit}, beyond its range {:.6g} .. {:.6g} {unit}: see scale and sign of its "
      "stream, and the model",
      joint.name, robot, shown(joint.position), shown(lower), shown(upper), fmt::arg("unit", prismatic ? "mm" : "deg"));
}

}  // namespace

std::vector<std::string> RangeWatch::look(Timestamp now, std::span<const RobotState> robots,
                                          std::span<const RobotSnapshot> snapshots) {
  std::vector<std::string> out;
  for (std::size_t i = 0; i < robots.size() && i < snapshots.size(); ++i) {
    const RobotState& robot = robots[i];
    if (!robot.online) continue;
    auto& watched = robots_[robot.id];
    for (std::size_t j = 0; j < std::min(robot.joints.size(), watched.size()); ++j) {
      const RobotJointState& joint = robot.joints[j];
      if (joint.state != DataState::fresh) continue;
      const double lower = snapshots[i].parameters.min_range[j];
      const double upper = snapshots[i].parameters.max_range[j];
      Watched& last = watched[j];
      if (!is_beyond(joint.position, lower, upper)) {
        last.told = false;
      } else if (!last.told && (!last.at.known() || now - last.at >= kToldAgainAfter)) {
        last = {true, now};
        out.push_back(beyond_text(robot.id, joint, lower, upper));
      }
    }
  }
  return out;
}

}  // namespace cellmirror::app
