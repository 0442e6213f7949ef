// Forces of the robots: plain data on its way to status, DDS and the picture's arrows. SI.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "rt_core/base/pose.hpp"
#include "rt_core/base/time.hpp"
#include "rt_core/ports/robot_parameters.hpp"
#include "rt_core/ports/robot_state.hpp"

namespace cellmirror {

struct Wrench {
  Eigen::Vector3d force = Eigen::Vector3d::Zero();   // N
  Eigen::Vector3d torque = Eigen::Vector3d::Zero();  // Nm
};

// Components of arrows (SET_FORCE_ARROW, manual/notes.md).
enum class ArrowComponent : std::uint8_t { none = 0, x = 1, y = 2, z = 3, resultant = 4 };

struct ForceArrowSettings {
  ArrowComponent joint_forces = ArrowComponent::none;
  ArrowComponent joint_torques = ArrowComponent::none;
  ArrowComponent tcp_force = ArrowComponent::none;
  bool motors_only = false;  // SET_FRC_ARR_SPECIAL: torque about, or force along, the joint's axis only
};

struct ForceLimits {      // SET_TORQUE_LIMIT; 0: no limit
  double max_force = 0;   // N
  double max_torque = 0;  // Nm
};

struct JointForce {
  std::string name;
  JointKind kind = JointKind::revolute;
  double position = 0;      // rad or m
  double velocity = 0;      // rad/s or m/s; zero where the data of a mirrored robot is too old
  double acceleration = 0;  // rad/s2 or m/s2, filtered
  double effort = 0;        // Nm or N, joint side, computed: of the drive, friction and rotor included
  double max_effort = 0;    // 0: not known
  bool beyond_limit = false;
  Wrench wrench_J;  // what the part before the joint gives to the part behind it, at its origin, in its frame
  Pose X_WJ = Pose::Identity();
  Eigen::Vector3d axis_J = Eigen::Vector3d::UnitZ();
};

struct RobotForces {
  std::string id;
  std::uint8_t slot = 0;
  bool computed = false;  // false: only the force at its TCP is known
  double model_kg = 0;    // of what its joints move, by its own model
  double payload_kg = 0;  // of what is attached beside
  std::vector<JointForce> joints;
  // Of the surroundings on the TCP, in its frame: of a haptic instrument's contact, and of what the robot holds.
  Wrench tcp_T;
  Pose X_WT = Pose::Identity();
  bool tcp_known = false;  // of a robot that is computed, or has a haptic device
};

// An arrow to be drawn: from `from_m`, along and as long as `vector` says (N or Nm), in the world.
struct ForceArrow {
  Eigen::Vector3d from_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d vector = Eigen::Vector3d::Zero();
  bool torque = false;
};

struct ForceState {
  Timestamp posture_time;
  std::uint64_t sequence = 0;
  std::vector<RobotForces> robots;  // those with masses in their models, and haptic instruments
};

// Receives forces, like RobotStateOutput.
class ForceOutput {
 public:
  virtual ~ForceOutput() = default;
  virtual void publish_forces(const ForceState& state) = 0;
};

}  // namespace cellmirror
