// The chain of joints from a base to a tip, in the form that forward kinematics, Jacobians and inverse kinematics want:
// fixed size, every joint along the z axis of its own frame. Immutable once made; any number of readers.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "rt_core/base/capacity.hpp"
#include "rt_core/base/object_id.hpp"
#include "rt_core/base/pose.hpp"
#include "rt_core/base/real_time.hpp"
#include "rt_core/base/result.hpp"
#include "rt_core/kinematics/forward_constants.hpp"
#include "rt_core/ports/robot_parameters.hpp"
#include "rt_core/ports/robot_state.hpp"

namespace cellmirror::kinematics {

inline constexpr std::size_t kMaxVariables = kMaxJointsPerRobot;

// A joint on the way from base to tip. Its value is multiplier * q[variable] + offset: rad about or m along z.
struct ChainJoint {
  Pose X_PJ = Pose::Identity();  // its frame at value zero, in the frame of the joint before it (first: in the base)
  JointKind kind = JointKind::revolute;
  std::uint8_t variable = 0;
  double multiplier = 1.0;  // other than 1 and 0 for mimics, and -1 for joints that are walked against their sense
  double offset = 0.0;
};

// What one variable (joint of the robot) may do. Continuous joints have the limits -inf and inf.
struct Variable {
  std::string name;
  JointKind kind = JointKind::revolute;
  double lower = 0;  // rad or m
  double upper = 0;
};

// Finite, and a right-handed rotation. For checks.
[[nodiscard]] bool is_pose(const Pose& X);
// Refused: limits that are not finite (but of continuous joints), and a lower one above the upper one.
[[nodiscard]] Result<void> check_limits(const Variable& variable);

class Chain {
 public:
  // Refused: nothing that moves, more than the capacities, a variable that no joint or that an unknown joint uses,
  // poses or numbers that are not finite or no rotations, a lower limit above the upper one (names the joint). X_LT:
  // the tip in the frame of the last joint.
  static Result<Chain> make(std::vector<Variable> variables, std::span<const ChainJoint> joints, const Pose& X_LT);

  [[nodiscard]] std::size_t variable_count() const CELL_RT { return variable_count_; }
  [[nodiscard]] std::span<const ChainJoint> joints() const CELL_RT { return {joints_.data(), joint_count_}; }
  [[nodiscard]] const Pose& X_LT() const CELL_RT { return X_LT_; }
  [[nodiscard]] const std::vector<Variable>& variables() const { return variables_; }
  // rad or m; infinite for continuous joints.
  [[nodiscard]] std::span<const double> lower() const CELL_RT { return {lower_.data(), variable_count_}; }
  [[nodiscard]] std::span<const double> upper() const CELL_RT { return {upper_.data(), variable_count_}; }
  [[nodiscard]] bool rotates(std::size_t variable) const CELL_RT { return rotates_[variable]; }
  // Every variable moves exactly one joint, as itself (no mimics): required by the specialised routines.
  [[nodiscard]] bool plain() const CELL_RT { return plain_; }

  // Middle of the range, zero for continuous joints.
  [[nodiscard]] JointValues middle() const CELL_RT;
  [[nodiscard]] bool within_limits(std::span<const double> q, double slack = 0.0) const CELL_RT;

  // The same chain with another tip (a tool), or with other limits (refused like make()).
  [[nodiscard]] Chain with_tip(const Pose& X_LT) const;
  [[nodiscard]] Result<Chain> with_limits(std::span<const double> lower, std::span<const double> upper) const;

  // How recordings name it.
  [[nodiscard]] std::uint64_t reference_id() const CELL_RT { return id_.value(); }
  // For forward().
  [[nodiscard]] const ForwardConstants& forward_constants() const CELL_RT { return forward_constants_; }

 private:
  Chain() = default;
  void set_tip(const Pose& X_LT);

  std::array<ChainJoint, kMaxChainJoints> joints_{};
  std::size_t joint_count_ = 0;
  std::size_t variable_count_ = 0;
  JointValues lower_{};
  JointValues upper_{};
  std::array<bool, kMaxVariables> rotates_{};
  bool plain_ = true;
  Pose X_LT_ = Pose::Identity();
  std::vector<Variable> variables_;
  ForwardConstants forward_constants_;
  ObjectId id_;
};

}  // namespace cellmirror::kinematics
