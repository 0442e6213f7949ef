#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "config/stream_reader.hpp"
#include "rt_core/base/dds_topic.hpp"
#include "rt_core/base/text.hpp"

namespace cellmirror {

namespace {

// The name without the slash in front; its topics begin with it.
std::optional<std::string> read_controller_name(TableReader& reader) {
  reader.require("name");
  const auto written = reader.text("name");
  if (!written) return std::nullopt;
  const std::string name = written->starts_with('/') ? written->substr(1) : *written;
  if (is_ros_topic("rt/" + name)) return name;
  reader.error("name", fmt::format("\"{}\" is not a name of ROS 2", printable(*written)),
               "letters, digits and _ between single slashes, e.g. /arm_controller");
  return std::nullopt;
}

// The key has its unit in its name.
double read_tolerance(TableReader& reader, const char* name, JointKind kind) {
  const std::string key = fmt::format("{}_{}", name, kind == JointKind::prismatic ? "m" : "rad");
  return reader.number(key, kNotNegative).value_or(0.0);
}

ControllerJoint read_joint(TableReader& reader, const RobotFacts* robot) {
  ControllerJoint joint;
  const auto reference = read_joint_reference(reader, robot);
  const bool in_metres = reader.has("path_tolerance_m") || reader.has("goal_tolerance_m");
  JointKind kind = in_metres ? JointKind::prismatic : JointKind::revolute;
  if (reference) {
    joint.joint = reference->number;
    joint.ros_name = reference->name;
    kind = reference->kind;
  }
  joint.ros_name = reader.text("ros_name").value_or(joint.ros_name);
  joint.path_tolerance = read_tolerance(reader, "path_tolerance", kind);
  joint.goal_tolerance = read_tolerance(reader, "goal_tolerance", kind);
  reader.finish();
  return joint;
}

void read_joints(TableReader& reader, const RobotFacts* robot, ControllerConfig& config) {
  for (TableReader& table : reader.tables("joint", kMaxJointsPerRobot)) {
    table.belongs_to("[[controller]], above its [[controller.joint]]", reader.known());
    ControllerJoint joint = read_joint(table, robot);
    for (const ControllerJoint& other : config.joints) {
      if (robot != nullptr && other.joint == joint.joint && !joint.ros_name.empty())
        table.error("joint", fmt::format("the joint {} is there twice", robot->joint_names[joint.joint]));
      if (other.ros_name == joint.ros_name && !joint.ros_name.empty())
        table.error("ros_name", fmt::format("two joints are called {}", printable(joint.ros_name)));
    }
    config.joints.push_back(std::move(joint));
  }
  if (!config.joints.empty() || robot == nullptr) return;
  for (std::size_t i = 0; i < robot->joint_names.size(); ++i)
    config.joints.push_back({.joint = i, .ros_name = robot->joint_names[i]});
}

}  // namespace

std::optional<ControllerConfig> read_controller(TableReader& reader, const RobotDirectory& robots, bool complete) {
  ControllerConfig config;
  config.place = reader.place();
  reader.require("robot");
  const auto robot = reader.text("robot");
  const RobotFacts* facts = nullptr;
  if (robot) {
    config.robot = *robot;
    reader.set_where("controller of " + printable(*robot));
    facts = find_robot(reader, *robot, robots, complete);
  }
  config.name = read_controller_name(reader).value_or("");
  constexpr long long kHighestDomain = 232;
  config.domain = static_cast<int>(reader.integer("domain", 0, kHighestDomain).value_or(0));
  config.interface_address = read_own_address(reader, "interface_address").value_or(config.interface_address);
  constexpr Range kSeconds{0.0, 3600.0};
  constexpr Range kStateRate{0.0, 500.0};
  config.goal_time = reader.number("goal_time_s", kSeconds).value_or(config.goal_time);
  config.stopped_velocity = reader.number("stopped_velocity", kNotNegative).value_or(config.stopped_velocity);
  config.allow_partial = reader.boolean("allow_partial_joints").value_or(config.allow_partial);
  config.state_rate_hz = reader.number("state_rate_hz", kStateRate).value_or(config.state_rate_hz);
  read_joints(reader, facts, config);
  reader.finish();
  if (!robot) return std::nullopt;
  return config;
}

}  // namespace cellmirror
