// What a ROS 2 controller is commanded (trajectory_msgs/JointTrajectory), and what is said of it. Plain data, SI: rad
// or m, s.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "rt_core/base/time.hpp"

namespace cellmirror {

// A message with more is refused. At 1 kHz these are ten seconds.
inline constexpr std::size_t kMaxTrajectoryPoints = 10'000;
inline constexpr std::size_t kMaxTrajectoryJoints = 64;  // names in a message

struct AxisState {
  double position = 0;      // rad or m
  double velocity = 0;      // rad/s or m/s
  double acceleration = 0;  // rad/s2 or m/s2
};

// Each array is empty or has a value for each joint of the message.
struct TrajectoryPoint {
  std::vector<double> positions = {};
  std::vector<double> velocities = {};
  std::vector<double> accelerations = {};
  std::vector<double> effort = {};
  Nanoseconds time_from_start{0};
};

struct JointTrajectory {
  std::optional<std::int64_t> start_wall_ns = {};  // since 1970 UTC; none: when it is taken
  std::vector<std::string> joints = {};
  std::vector<TrajectoryPoint> points = {};
};

// Of one joint, as control_msgs/JointTolerance has it. 0: not given, the controller's own holds; below 0: none.
struct TrajectoryTolerance {
  std::string joint = {};
  double position = 0;
  double velocity = 0;
  double acceleration = 0;
};

using GoalId = std::array<std::uint8_t, 16>;  // unique_identifier_msgs/UUID

// Of the action FollowJointTrajectory.
struct TrajectoryGoal {
  GoalId id{};
  std::vector<TrajectoryTolerance> path = {};
  std::vector<TrajectoryTolerance> goal = {};
  Nanoseconds goal_time{0};  // 0: the controller's own; below 0: no limit
  bool multi_dof = false;    // the goal has points of joints with several axes, which no robot here has
};

// Why a trajectory was not taken. Each has a counter.
enum class TrajectoryRefusal : std::uint8_t {
  malformed,        // no message of that type
  too_many_points,  // or joints
  joints,           // unknown, twice, or some are missing
  sizes,            // arrays are not as long as the joints
  times,            // not ascending, or below 0
  not_finite,
  no_positions,
  end_velocity,  // its last point does not stand still
  beyond_range,
  past,      // it has ended already
  mirrored,  // the robot is online, and follows its own controller
  busy,      // a robot program moves the robot, joints follow a master, or too much waits
  failed,    // the loop did not take it
};
inline constexpr std::size_t kTrajectoryRefusals = 13;
[[nodiscard]] constexpr std::string_view words(TrajectoryRefusal refusal) {
  constexpr std::array<std::string_view, kTrajectoryRefusals> kWords = {
      "malformed",    "too_many_points", "joints", "sizes",    "times", "not_finite", "no_positions",
      "end_velocity", "beyond_range",    "past",   "mirrored", "busy",  "failed"};
  return kWords[static_cast<std::size_t>(refusal)];
}

}  // namespace cellmirror
