// What is known of the ROS 2 controller of a robot: for status and for what it publishes.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "rt_core/base/time.hpp"
#include "rt_core/ports/joint_trajectory.hpp"
#include "rt_core/ports/robot_state.hpp"
#include "rt_core/ports/trajectory_endpoint.hpp"

namespace cellmirror::app {

struct ControllerCounts {
  std::uint64_t taken = 0;     // trajectories that were given to the loop
  std::uint64_t replaced = 0;  // that a newer one took the place of
  std::uint64_t stops = 0;     // empty ones
  std::array<std::uint64_t, kTrajectoryRefusals> refused{};
  [[nodiscard]] std::uint64_t all_refused() const {
    std::uint64_t sum = 0;
    for (const std::uint64_t one : refused) sum += one;
    return sum;
  }
};

// Of the action.
struct GoalCounts {
  std::uint64_t taken = 0;
  std::uint64_t refused = 0;
  std::uint64_t succeeded = 0;
  std::uint64_t canceled = 0;
  std::uint64_t aborted = 0;
};

struct ControllerJointSnapshot {
  std::size_t number = 0;  // of the robot, from 0
  std::string name;        // of the robot
  std::string ros_name;
  JointKind kind = JointKind::revolute;
};

struct ControllerSnapshot {
  std::string name;
  std::string robot;
  std::size_t slot = 0;
  bool there = false;  // the cell has the robot
  std::vector<ControllerJointSnapshot> joints;
  std::shared_ptr<TrajectoryEndpoint> endpoint;  // status() is asked from other threads
  Nanoseconds period{0};                         // of the state that it publishes; 0: none
  ControllerCounts counts;
  GoalCounts goals;
  std::uint32_t newest = 0;  // id of the trajectory that was taken last; 0: none
  double duration_s = 0;     // of it
  std::size_t points = 0;    // of it
  std::string last_refusal;  // in words; empty: none
  Timestamp refused_at;
};

}  // namespace cellmirror::app
