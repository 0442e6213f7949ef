#include "config/robot_builder.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>
#include <vector>

#include "rt_core/base/capacity.hpp"
#include "rt_core/base/text.hpp"

namespace cellmirror {

namespace {

ComponentNode* joint_named(Component& component, std::string_view name) {
  const auto found =
      std::ranges::find_if(component.nodes, [&](const ComponentNode& node) { return node.joint && node.name == name; });
  return found == component.nodes.end() ? nullptr : &*found;
}

// A mimic of a mimic follows that one's joint: factors multiply, offsets add. What remains is one step.
void resolve_chains_of_mimics(Component& component, Diagnostics& diagnostics) {
  for (ComponentNode& node : component.nodes) {
    if (!node.joint || !node.joint->mimic) continue;
    Mimic mimic = *node.joint->mimic;
    std::size_t steps = 0;
    const ComponentNode* master = joint_named(component, mimic.joint);
    while (master != nullptr && master->joint->mimic && steps <= component.nodes.size()) {
      const Mimic& next = *master->joint->mimic;
      mimic = {next.joint, mimic.multiplier * next.multiplier, mimic.multiplier * next.offset + mimic.offset};
      master = joint_named(component, next.joint);
      ++steps;
    }
    if (steps > component.nodes.size()) {
      diagnostics.error(component.place(node),
                        fmt::format("{} mimics itself by way of {}", node.name, printable(node.joint->mimic->joint)));
      return;
    }
    node.joint->mimic = mimic;
  }
}

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
                      exists ? fmt::format("{} mimics {}, which is not a joint that moves by itself", node.name, name)
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
  resolve_chains_of_mimics(component, diagnostics);
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
