// From the gateway's robot states and frames to ROS 2 messages. Pure.
#pragma once

#include <cstddef>
#include <map>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "drivers/dds/ros2_messages.hpp"
#include "rt_core/ports/robot_state.hpp"

namespace cellmirror::dds {

// Gives each joint its name on the topic: its own, as ROS 2 expects, or "robot/joint" from the moment on that a second
// robot with a joint of that name was seen. That never falls back, so that names do not flicker when outputs are
// switched on and off.
class JointNames {
 public:
  // To be called with all robots of a message before names are asked for.
  void see(std::span<const RobotState> robots);
  [[nodiscard]] std::string name(const std::string& robot, const std::string& joint) const;

 private:
  std::map<std::string, std::string, std::less<>> owner_;  // joint name -> the first robot that had it
  std::set<std::string, std::less<>> shared_;              // joint names that more than one robot has
};

// All robots of one instant in one message: position, velocity and effort of every joint. Joints whose values are not
// finite are left out; returns how many. `message` is overwritten.
std::size_t fill_joint_state(RosTime stamp, std::span<const RobotState> robots, const JointNames& names,
                             JointState& message);

// One transform a frame, child in parent, unit quaternion. Poses that are not finite are left out; returns how many.
std::size_t fill_transforms(RosTime stamp, std::span<const FramePose> frames, TfMessage& message);

}  // namespace cellmirror::dds
