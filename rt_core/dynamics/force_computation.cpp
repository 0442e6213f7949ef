#include "rt_core/dynamics/force_computation.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "rt_core/base/contract.hpp"
#include "rt_core/base/log.hpp"
#include "rt_core/kinematics/joint_motion.hpp"

namespace cellmirror::dynamics {

namespace {

// After a warning the effort must fall below this part of the limit before there is another.
constexpr double kBackWithin = 0.95;

const HapticState* haptic_of(std::span<const HapticState> haptics, std::size_t slot) {
  const auto found = std::ranges::find_if(
      haptics, [&](const HapticState& haptic) { return haptic.phase != HapticPhase::closed && haptic.slot == slot; });
  return found == haptics.end() ? nullptr : &*found;
}

}  // namespace

bool ForceComputation::take_cell(const std::shared_ptr<const CompiledCell>& cell) {
  if (cell == cell_) return false;
  const bool same = cell_ && dynamics::same_masses(*cell_, *cell);
  cell_ = cell;
  if (same) return false;
  mechanisms_ = dynamics::robot_mechanisms(*cell);
  poses_.reserve(cell->size());
  has_mechanisms_ = false;
  not_computed_.clear();
  for (std::size_t i = 0; i < mechanisms_.size(); ++i) {
    has_mechanisms_ = has_mechanisms_ || mechanisms_[i].mechanism.has_value();
    if (!mechanisms_[i].why_not.empty()) not_computed_.push_back({cell->robots[i].id, mechanisms_[i].why_not});
  }
  return true;
}

ForceComputation::SlotState& ForceComputation::slot_state(std::size_t slot) {
  if (slots_.size() <= slot) {
    slots_.resize(slot + 1);
    positions_.resize(slot + 1);
  }
  return slots_[slot];
}

void ForceComputation::update_motions(std::span<const RobotMotion> motions) {
  for (std::size_t i = 0; i < cell_->robots.size(); ++i) {
    const CompiledRobot& robot = cell_->robots[i];
    const RobotMotion& from = motions[i];
    const std::size_t n = robot.joint_names.size();
    MotionEstimate& motion = slot_state(robot.slot).motion;
    positions_[robot.slot] = from.position;
    if (from.fresh) {
      motion.take(from.time, std::span(from.position).first(n), std::span(from.velocity).first(n), from.mirrored);
    } else {
      motion.stand_still();
    }
  }
}

void ForceComputation::place_links(const Mechanism& mechanism, std::span<const double> q) {
  const auto links = mechanism.links();
  for (std::size_t i = 0; i < links.size(); ++i) {
    const Link& link = links[i];
    const int parent = link.parent;
    X_WJ_[i] = parent < 0 ? link.X_PJ : X_WJ_[static_cast<std::size_t>(parent)] * link.X_PJ;
    kinematics::apply_joint(link.kind, link.axis, link.multiplier * q[link.variable] + link.offset, X_WJ_[i]);
  }
}

void ForceComputation::compute_robot(const RobotMechanism& robot, RobotForces& out) {
  const Mechanism& mechanism = *robot.mechanism;
  const CompiledRobot& compiled = *cell_->robot(robot.slot);
  JointValues q{};
  JointValues qd{};
  JointValues qdd{};
  for (std::size_t i = 0; i < robot.variables.size(); ++i) {
    const auto [slot, joint] = robot.variables[i];
    q[i] = positions_[slot][joint];
    qd[i] = slots_[slot].motion.velocity()[joint];
    qdd[i] = slots_[slot].motion.acceleration()[joint];
  }
  const DynamicsInput motion{q, qd, qdd, gravity_W_, out.tcp_T.force, out.tcp_T.torque};
  inverse_dynamics(mechanism, motion, output_);
  place_links(mechanism, q);
  out.model_kg = robot.model_kg;
  out.payload_kg = robot.payload_kg;
  out.joints.resize(compiled.joint_names.size());
  for (std::size_t i = 0; i < out.joints.size(); ++i) {
    JointForce& joint = out.joints[i];
    joint.name = compiled.joint_names[i];
    joint.kind = compiled.joint_kinds[i];
    joint.position = q[i];
    joint.velocity = qd[i];
    joint.acceleration = qdd[i];
    joint.effort = output_.effort[i];
    joint.max_effort = mechanism.drive(i).max_effort;
    joint.beyond_limit = joint.max_effort > 0.0 && std::abs(joint.effort) > joint.max_effort;
    const auto link = static_cast<std::size_t>(robot.joint_links[i]);
    joint.wrench_J = output_.joint_wrench[link];
    joint.X_WJ = X_WJ_[link];
    joint.axis_J = mechanism.links()[link].axis;
  }
  if (mechanism.tip_link() < 0) return;
  out.X_WT = X_WJ_[static_cast<std::size_t>(mechanism.tip_link())] * mechanism.X_LT();
  out.tcp_known = true;
  if (robot.load) add_load(*robot.load, motion, out);
}

// What the links give to the load at the tip's joint, the load gives back to them at the TCP.
void ForceComputation::add_load(const Mechanism& load, const DynamicsInput& motion, RobotForces& out) {
  DynamicsInput without_contact = motion;
  without_contact.tip_force_T.setZero();
  without_contact.tip_torque_T.setZero();
  inverse_dynamics(load, without_contact, output_);
  const Wrench& wrench_J = output_.joint_wrench[static_cast<std::size_t>(load.tip_link())];
  const Pose& X_JT = load.X_LT();
  const Eigen::Matrix3d R_TJ = X_JT.linear().transpose();
  out.tcp_T.force -= R_TJ * wrench_J.force;
  out.tcp_T.torque -= R_TJ * (wrench_J.torque - Eigen::Vector3d(X_JT.translation()).cross(wrench_J.force));
}

void ForceComputation::check_limits(const RobotForces& robot) {
  auto& beyond = slots_[robot.slot].beyond_limit;
  for (std::size_t i = 0; i < robot.joints.size(); ++i) {
    const JointForce& joint = robot.joints[i];
    bool& was = beyond[i];
    if (joint.beyond_limit && !was) {
      ++limit_warnings_;
      const char* unit = joint.kind == JointKind::prismatic ? "N" : "Nm";
      log_warning("forces.limit", "{} {} needs {:.1f} {}, beyond its {:.1f} {}", robot.id, joint.name, joint.effort,
                  unit, joint.max_effort, unit);
    }
    was = joint.beyond_limit || (was && std::abs(joint.effort) > kBackWithin * joint.max_effort);
  }
}

void ForceComputation::compute_contact(const HapticState* haptic, const InstrumentLoad* load, std::size_t robot,
                                       RobotForces& out) {
  out.tcp_known = haptic != nullptr || load != nullptr;
  out.tcp_T = {};
  out.X_WT = Pose::Identity();
  // The force on the hand is the force on the tip.
  if (haptic != nullptr) {
    out.tcp_T = {haptic->force_E, Eigen::Vector3d(0, 0, haptic->axis_torque)};
  } else if (load != nullptr) {
    out.tcp_T = {load->force_T, load->torque_T};
  } else {
    return;
  }
  const std::optional<Mechanism>& mechanism = mechanisms_[robot].mechanism;
  if (mechanism && mechanism->tip_link() >= 0) return;  // place_links() gave the pose
  compute_poses(*cell_, positions_, poses_);
  out.X_WT = tcp_poses(cell_->robots[robot], poses_).X_WT;
}

// Computes the drive efforts of a robot without masses against the wrench at the TCP: -J^T w (Siciliano et al.,
// Robotics, 3.8). Call it after compute_contact(), which computes the poses.
void ForceComputation::compute_joints_of_load(const CompiledRobot& robot, RobotForces& out) {
  const Eigen::Vector3d force_W = out.X_WT.linear() * out.tcp_T.force;
  const Eigen::Vector3d torque_W = out.X_WT.linear() * out.tcp_T.torque;
  out.joints.assign(robot.joint_names.size(), JointForce{});
  for (std::size_t i = 0; i < out.joints.size(); ++i) {
    out.joints[i].name = robot.joint_names[i];
    out.joints[i].kind = robot.joint_kinds[i];
    out.joints[i].position = positions_[robot.slot][i];
  }
  for (std::int32_t node = robot.flange; node >= 0; node = cell_->parent[static_cast<std::size_t>(node)]) {
    const std::int32_t of = cell_->joint_of[static_cast<std::size_t>(node)];
    if (of < 0) continue;
    const CompiledJoint& joint = cell_->joints[static_cast<std::size_t>(of)];
    if (joint.slot != robot.slot || joint.joint >= out.joints.size()) continue;
    const Pose& X_WJ = poses_.X_WN[static_cast<std::size_t>(node)];
    const Eigen::Vector3d axis_W = X_WJ.linear() * joint.axis;
    const Eigen::Vector3d arm = out.X_WT.translation() - X_WJ.translation();
    const double effort =
        joint.kind == JointKind::prismatic ? axis_W.dot(force_W) : axis_W.dot(arm.cross(force_W) + torque_W);
    JointForce& to = out.joints[joint.joint];
    to.effort -= joint.multiplier * effort;
    to.X_WJ = X_WJ;
    to.axis_J = joint.axis;
  }
}

void ForceComputation::compute(Timestamp time, std::span<const RobotMotion> motions,
                               std::span<const HapticState> haptics, const InstrumentLoads* loads, ForceState& state) {
  CELLMIRROR_EXPECTS(cell_ && motions.size() == cell_->robots.size());
  update_motions(motions);
  state.posture_time = time;
  std::size_t used = 0;
  for (std::size_t i = 0; i < mechanisms_.size(); ++i) {
    const CompiledRobot& robot = cell_->robots[i];
    const bool has_masses = mechanisms_[i].mechanism.has_value();
    const HapticState* haptic = haptic_of(haptics, robot.slot);
    const InstrumentLoad* load = haptic != nullptr || loads == nullptr ? nullptr : loads->find(robot.slot, time);
    if (!has_masses && haptic == nullptr && load == nullptr) continue;
    if (state.robots.size() == used) state.robots.emplace_back();
    RobotForces& out = state.robots[used++];
    out.id = robot.id;
    out.slot = static_cast<std::uint8_t>(robot.slot);
    out.computed = has_masses;
    compute_contact(haptic, load, i, out);
    if (has_masses) {
      compute_robot(mechanisms_[i], out);
      check_limits(out);
    } else {
      out.joints.clear();
      out.model_kg = out.payload_kg = 0;
      if (load != nullptr) compute_joints_of_load(robot, out);
    }
  }
  state.robots.resize(used);
}

}  // namespace cellmirror::dynamics
