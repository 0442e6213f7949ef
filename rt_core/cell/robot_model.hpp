// A robot of the cell: where it is in the tree, its joints, and the parameters that SCRIPT sets (manual 1.2.2). The
// setters check everything against the robot; a refused call changes nothing. One thread: the owner of the cell.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "rt_core/base/result.hpp"
#include "rt_core/cell/component.hpp"
#include "rt_core/ports/robot_parameters.hpp"
#include "rt_core/ports/robot_state.hpp"

namespace cellmirror {

// Names a node of a Cell as long as it exists.
enum class NodeId : std::uint32_t {};
inline constexpr NodeId kRootNode{0};
inline constexpr NodeId kNoNode{0xFFFF'FFFF};

struct RobotJoint {
  std::string name;
  JointKind kind = JointKind::revolute;
  NodeId node = kNoNode;
  JointDrive drive;
};

class RobotModel {
 public:
  RobotModel(std::string id, std::size_t slot, const RobotParameters& parameters)
      : id_(std::move(id)), slot_(slot), parameters_(parameters) {
    parameters_.requested = {parameters.start_position, parameters.active_velocity, parameters.active_acceleration};
  }

  [[nodiscard]] const std::string& id() const { return id_; }
  // 0..kMaxRobots-1; the same for the same id as long as the cell lives, also when the robot is deleted and loaded
  // again.
  [[nodiscard]] std::size_t slot() const { return slot_; }
  [[nodiscard]] NodeId component() const { return component_; }  // the node whose ABSTRACT file holds it
  [[nodiscard]] NodeId base() const { return base_; }
  [[nodiscard]] NodeId zero_point() const { return zero_point_; }  // the ZP frame
  [[nodiscard]] NodeId flange() const { return flange_; }
  [[nodiscard]] std::size_t joint_count() const { return joints_.size(); }
  [[nodiscard]] std::span<const RobotJoint> joints() const { return joints_; }
  [[nodiscard]] std::span<const JointKind> joint_kinds() const { return joint_kinds_; }
  [[nodiscard]] std::vector<std::string> joint_names() const;
  // What the robot's file says that its joints can do; empty where it was made without one. SCRIPT does not change it.
  [[nodiscard]] std::span<const KnownLimits> known_limits() const { return known_limits_; }
  [[nodiscard]] const RobotParameters& parameters() const { return parameters_; }
  [[nodiscard]] Pose X_FT() const;  // TCP in the flange

  // One value a joint, SI. Ranges: minimum below maximum. Start position: inside the range. Velocities and
  // accelerations: positive; minimum velocity: zero or more, not above the maximum; active values: not above the
  // maximum. A limit that is narrowed limits what is in force (start position, active velocity, active acceleration),
  // not what was requested: where it is widened again, that is in force again.
  Result<void> set_joint_parameter(JointParameter which, std::span<const double> values);
  Result<void> set_scalar_parameter(ScalarParameter which, double value);
  Result<void> set_fly(FlyType type, double parameter);
  void set_ptp_mode(PtpMode mode) { parameters_.ptp_mode = mode; }
  void set_velocity_profile(VelocityProfile profile) { parameters_.velocity_profile = profile; }
  void set_inverse_class(InverseClass inverse_class) { parameters_.inverse_class = inverse_class; }
  Result<void> set_point_of_reference(const Pose& X_FP);
  Result<void> set_tool_center_point(const Pose& X_PT);

  // POS_ROB JOINT_ABS: the joints' new positions, where `values` holds those of the first joints and `current` all.
  // Refused: more values than joints, values that are not finite or beyond a limit (names the joint, value and limit).
  [[nodiscard]] Result<JointValues> positions_to(std::span<const double> values, const JointValues& current) const;
  // POS_ROB JOINT_INC.
  [[nodiscard]] Result<JointValues> positions_by(std::span<const double> increments, const JointValues& current) const;

 private:
  friend class CellBuilder;
  [[nodiscard]] Result<void> check_position(std::size_t joint, double value) const;
  [[nodiscard]] Result<void> check_count(std::size_t values) const;

  std::string id_;
  std::size_t slot_;
  RobotParameters parameters_;
  NodeId component_ = kNoNode;
  NodeId base_ = kNoNode;
  NodeId zero_point_ = kNoNode;
  NodeId flange_ = kNoNode;
  std::vector<RobotJoint> joints_;
  std::vector<JointKind> joint_kinds_;
  std::vector<KnownLimits> known_limits_;
};

// "0.5236 rad (30 deg)" or "0.25 m (250 mm)": a joint's position for people.
[[nodiscard]] std::string position_text(JointKind kind, double value);

}  // namespace cellmirror
