// What the tick publishes: the state of every robot at one instant.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "rt_core/base/capacity.hpp"
#include "rt_core/base/time.hpp"
#include "rt_core/motion/executor.hpp"
#include "rt_core/motion/trajectory_follower.hpp"
#include "rt_core/ports/haptic_state.hpp"
#include "rt_core/ports/joint_stream.hpp"
#include "rt_core/ports/plausibility.hpp"
#include "rt_core/ports/robot_parameters.hpp"

namespace cellmirror::engine {

enum class RobotMode : std::uint8_t {
  absent,     // the slot is not used
  simulated,  // the model is moved by commands
  mirrored,   // the model follows a stream (`ROBOT <id> online`)
};

struct JointTickState {
  double position = 0;  // rad or m; the last good value, whatever its age
  double velocity = 0;  // rad/s or m/s; of a simulated robot that of its move
  double effort = 0;    // Nm or N
  Timestamp receive_time = {};
  Timestamp source_time = {};
  DataState state = DataState::none;
  Implausibility implausible = Implausibility::none;  // why, where the state is `implausible`
};

// Of a slave (MASTER_SLAVE). Joints are bits, bit 0 the first.
struct FollowTickState {
  std::uint8_t master = 0;    // slot; means something where joints is not 0
  bool holding = false;       // the master's data are not fresh: a joint stays where it is
  std::uint16_t joints = 0;   // that follow
  std::uint16_t limited = 0;  // that are kept behind the master by their velocity or their range

  [[nodiscard]] bool follows() const { return joints != 0; }
};

// All of a robot but its joints.
struct RobotTickHead {
  RobotMode mode = RobotMode::absent;
  std::uint8_t joint_count = 0;
  DataState state = DataState::none;  // the worst of the joints whose position the stream gives
  std::uint64_t sequence = 0;         // of the newest sample
  Timestamp receive_time;             // of the newest sample
  std::uint64_t samples = 0;          // taken from the stream's queue since the robot went online
  std::uint64_t refused_values = 0;   // not finite, or named as refused by the driver
  // Counted as refused_values, and none of them: values that cannot be true, and values of two senders.
  std::uint64_t implausible_values = 0;
  std::uint64_t conflicting_values = 0;
  ImplausibleValue newest_implausible;
  std::uint64_t refused_setpoints = 0;  // by the limiter
  motion::MotionState motion;           // of a simulated robot
  FollowTickState follow;               // of a simulated robot
};

struct RobotTickState : RobotTickHead {
  std::array<JointTickState, kMaxJointsPerRobot> joints{};  // the first joint_count count
  motion::TrajectoryState trajectory;                       // of a simulated robot; not in recordings
};

struct TickState {
  explicit TickState(std::size_t robot_capacity = 0) : robots(robot_capacity) {}

  std::uint64_t tick = 0;
  Timestamp time;                    // the one reading of the clock of that tick
  std::uint64_t missed_periods = 0;  // since the start
  std::uint64_t commands_done = 0;   // id of the newest command that was carried out
  std::uint64_t commands_refused = 0;
  std::vector<RobotTickState> robots;  // by slot; the size never changes
  std::array<HapticState, kMaxHapticDevices> haptics{};
};

}  // namespace cellmirror::engine
