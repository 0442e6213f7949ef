// Makes what the tick follows of a trajectory that a ROS 2 controller was commanded, and refuses what it would not.
// Real-time class: none; some milliseconds for the longest. Any thread.
#pragma once

#include <expected>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "rt_core/base/time.hpp"
#include "rt_core/motion/trajectory.hpp"
#include "rt_core/ports/joint_trajectory.hpp"
#include "rt_core/ports/robot_parameters.hpp"
#include "rt_core/ports/robot_state.hpp"

namespace cellmirror::planning {

// A joint of the robot that a controller moves.
struct TrajectoryJoint {
  std::size_t number = 0;       // of the robot, from 0
  std::string name;             // in messages
  double path_tolerance = 0;    // rad or m; 0: none
  double goal_tolerance = 0;    // likewise
  double stopped_velocity = 0;  // rad/s or m/s; 0: any at the end
};

struct TrajectoryController {
  std::vector<TrajectoryJoint> joints;
  double goal_time = 0;        // s; 0: no limit
  bool allow_partial = false;  // a message may leave joints out: they stay where they stand
};

struct TrajectoryRobot {
  std::span<const JointKind> kinds;  // of its joints
  const RobotParameters& parameters;
};

// When the trajectory arrived, and when it begins: header.stamp. `start` never: when the tick takes it.
struct TrajectoryTimes {
  Timestamp now;
  Timestamp start = {};
};

struct TrajectoryFault {
  TrajectoryRefusal refusal = TrajectoryRefusal::malformed;
  std::string text;  // for people, with the joint, the point and the value
};

// `message` has at least one point. `goal`: tolerances that replace those of the controller; null: none. Sets all but
// the id.
[[nodiscard]] std::expected<motion::Trajectory, TrajectoryFault> plan_trajectory(const TrajectoryController& controller,
                                                                                 const TrajectoryRobot& robot,
                                                                                 const JointTrajectory& message,
                                                                                 const TrajectoryGoal* goal,
                                                                                 const TrajectoryTimes& times);

}  // namespace cellmirror::planning
