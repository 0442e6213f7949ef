// The published state of robots: on the SENSOR channel, on DDS, to displays.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "rt_core/base/capacity.hpp"
#include "rt_core/base/pose.hpp"
#include "rt_core/base/time.hpp"
#include "rt_core/ports/joint_stream.hpp"
#include "rt_core/ports/plausibility.hpp"

namespace cellmirror {

enum class JointKind : std::uint8_t { revolute, continuous, prismatic };

struct RobotJointState {
  std::string name;
  JointKind kind = JointKind::revolute;
  double position = 0;                // rad or m
  double velocity = 0;                // rad/s or m/s
  double effort = 0;                  // Nm or N
  DataState state = DataState::none;  // `none` for a robot that is not mirrored
  Timestamp source_time;
  Timestamp receive_time;
  Implausibility implausible = Implausibility::none;  // why, where the state is `implausible`
};

// One robot at one tick.
struct RobotState {
  std::string id;
  bool online = false;         // mirrored
  std::uint64_t sequence = 0;  // of the sample, or of the tick where not mirrored
  DataState state = DataState::none;
  std::vector<RobotJointState> joints;
  Pose X_BT = Pose::Identity();  // TCP in the robot's base
  Pose X_WT = Pose::Identity();  // TCP in the world
};

// The pose of one frame for /tf: child in parent.
struct FramePose {
  std::string parent;
  std::string child;
  Pose X_PC = Pose::Identity();
};

// Receives robot states at the cell file's rate, outside the tick. One calling thread (the publisher). Never blocks for
// long; what cannot be delivered is dropped and counted by the implementation.
class RobotStateOutput {
 public:
  virtual ~RobotStateOutput() = default;
  // `time`: the tick's instant. `robots`: those for which output is switched on (`ROBOT <id> send_on`).
  virtual void publish(Timestamp time, std::span<const RobotState> robots, std::span<const FramePose> frames) = 0;
  // {"sent", n}, {"dropped", n}, ...; any thread.
  [[nodiscard]] virtual std::vector<std::pair<std::string, std::uint64_t>> counters() const = 0;
  [[nodiscard]] virtual std::string name() const = 0;
  // Why it reaches nobody, with the remedy; empty: nothing is known against it. Any thread.
  [[nodiscard]] virtual std::string problem() const { return {}; }
  // Called regularly by the thread that publishes, also while there is nothing to publish.
  virtual void keep(Timestamp /*now*/) {}
};

}  // namespace cellmirror
