#include "config/robot_builder.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "rt_core/base/capacity.hpp"
#include "rt_core/base/text.hpp"

namespace cellmirror {

namespace {

void check_mimics(const Component& component, Diagnostics& diagnostics) {
  std::vector<std::string> masters;
  for (const ComponentNode& node : component.nodes) {
    if (node.joint && !node.joint->mimic) masters.push_back(node.name);
  }
  for (const ComponentNode& node : component.nodes) {
    if (!node.joint || !node.joint->mimic) continue;
    if (std::ranges::find(masters, node.joint->mimic->joint) != masters.end()) continue;
    const std::string& name = node.joint->mimic->joint;
    const bool exists = std::ranges::find(component.nodes, name, &ComponentNode::name) != component.nodes.end();
    diagnostics.error(component.place(node),
                      exists ? fmt::format("{} mimics {}, which is a mimic itself or not a joint", node.name, name)
                             : fmt::format("{} mimics {}, which does not exist", node.name, printable(name)),
                      did_you_mean(name, masters));
  }
}

void copy_parameters(const JointDefinition& joint, std::size_t i, RobotParameters& p) {
  p.max_range[i] = joint.max_position;
  p.min_range[i] = joint.min_position;
  p.start_position[i] = joint.start_position;
  p.reference_position[i] = joint.reference_position;
  p.max_velocity[i] = joint.max_velocity;
  p.min_velocity[i] = joint.min_velocity;
  p.active_velocity[i] = joint.max_velocity;
  p.max_acceleration[i] = joint.max_acceleration;
  p.active_acceleration[i] = joint.max_acceleration;
}

// What a mirrored robot's values are checked against. Scripts set parameters for simulated motion; these stay.
KnownLimits limits_of(const JointDefinition& joint) {
  KnownLimits limits;
  if (joint.kind != JointKind::continuous) {
    limits.lower = joint.min_position;
    limits.upper = joint.max_position;
  }
  if (joint.velocity_given) limits.velocity = joint.max_velocity;
  if (joint.acceleration_given) limits.acceleration = joint.max_acceleration;
  return limits;
}

bool is_above(const Component& component, int above, int node) {
  if (above < 0) return true;
  for (int at = node; at >= 0; at = component.nodes[static_cast<std::size_t>(at)].parent) {
    if (at == above) return true;
  }
  return false;
}

}  // namespace

void complete_robot(Component& component, const Place& place, Diagnostics& diagnostics) {
  RobotDefinition& robot = *component.robot;
  check_mimics(component, diagnostics);
  for (std::size_t i = 0; i < component.nodes.size(); ++i) {
    const auto& joint = component.nodes[i].joint;
    if (!joint || joint->mimic) continue;
    const std::string& name = component.nodes[i].name;
    const bool twice = std::ranges::any_of(
        robot.joints, [&](int other) { return component.nodes[static_cast<std::size_t>(other)].name == name; });
    if (twice) {
      diagnostics.error(component.place(component.nodes[i]), fmt::format("the robot has two joints {}", name));
      continue;
    }
    if (robot.joints.size() == kMaxJointsPerRobot) {
      diagnostics.error(component.place(component.nodes[i]),
                        fmt::format("the robot {} has more than {} joints", robot.id, kMaxJointsPerRobot));
      break;
    }
    copy_parameters(*joint, robot.joints.size(), robot.parameters);
    robot.limits.push_back(limits_of(*joint));
    robot.joints.push_back(static_cast<int>(i));
  }
  if (robot.joints.empty()) diagnostics.error(place, fmt::format("the robot {} has no joint", robot.id));
  if (!is_above(component, robot.base, robot.flange))
    diagnostics.error(place, fmt::format("the flange of {} is not connected to its base", robot.id));
}

}  // namespace cellmirror
