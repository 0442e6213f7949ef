// The members of the plain data that a recording of the tick has (rt_core/base/state_bytes.hpp): one list each, for
// writing and for reading.
#pragma once

#include <cstddef>
#include <cstdint>

#include "rt_core/base/real_time.hpp"
#include "rt_core/base/state_bytes.hpp"
#include "rt_core/engine/coupling.hpp"
#include "rt_core/engine/limiter.hpp"
#include "rt_core/engine/tick_state.hpp"
#include "rt_core/haptics/contact_model.hpp"
#include "rt_core/haptics/instrument_map.hpp"
#include "rt_core/haptics/settings.hpp"
#include "rt_core/haptics/tissue_coupling.hpp"
#include "rt_core/haptics/tissue_force.hpp"
#include "rt_core/kinematics/task.hpp"
#include "rt_core/motion/executor.hpp"
#include "rt_core/motion/move.hpp"
#include "rt_core/ports/haptic_device.hpp"
#include "rt_core/ports/haptic_state.hpp"
#include "rt_core/ports/joint_stream.hpp"
#include "rt_core/ports/plausibility.hpp"

// In the namespace of the archives, through which they are found.
namespace cellmirror {

template <class Archive>
void transfer(Archive& archive, KnownLimits& value) CELL_RT {
  archive(value.lower, value.upper, value.velocity, value.acceleration);
}

template <class Archive>
void transfer(Archive& archive, PlausibilityBounds& value) CELL_RT {
  archive(value.joints, value.arrival_jitter, value.frozen_after, value.plausible_after);
}

template <class Archive>
void transfer(Archive& archive, engine::JointLimits& value) CELL_RT {
  archive(value.lower, value.upper, value.velocity, value.acceleration, value.jerk);
}

template <class Archive>
void transfer(Archive& archive, engine::JointRate& value) CELL_RT {
  archive(value.velocity, value.acceleration);
}

template <class Archive>
void transfer(Archive& archive, engine::Coupling& value) CELL_RT {
  // Recordings of versions that had no accelerations have the number alone.
  constexpr std::uint16_t kWithAccelerations = 0x100;
  archive(value.master, value.slave, value.max_velocity);
  auto number = static_cast<std::uint16_t>(value.count | kWithAccelerations);
  archive.bounded(number, kMaxJointsPerRobot | kWithAccelerations);
  value.count = static_cast<std::uint8_t>(number & 0xFF);
  for (CoupledJoint& joint : value.joints) archive(joint.master_joint, joint.slave_joint);
  if ((number & kWithAccelerations) != 0) archive(value.max_acceleration);
}

template <class Archive>
void transfer(Archive& archive, kinematics::Task& value) CELL_RT {
  archive.choice(value.orientation, kinematics::OrientationTask::approach);
  archive.choice(value.secondary, kinematics::Secondary::even_bend);
  archive(value.position_axes, value.orientation_required, value.bent_joints);
}

template <class Archive>
void transfer(Archive& archive, motion::Move& value) CELL_RT {
  archive.choice(value.kind, motion::MoveKind::delay);
  archive.choice(value.start, motion::Start::queue);
  archive.choice(value.profile, VelocityProfile::ramp);
  archive.choice(value.ptp_mode, PtpMode::asynchronous);
  archive.choice(value.fly_type, FlyType::angle);
  archive(value.id, value.max_velocity, value.min_velocity, value.target, value.velocity, value.acceleration,
          value.X_BG, value.task, value.linear_velocity, value.linear_acceleration, value.rotational_velocity,
          value.rotational_acceleration, value.p_BV, value.fly_parameter, value.delay_s, value.begin, value.follows_on);
}

template <class Archive>
void transfer(Archive& archive, motion::Arc& value) CELL_RT {
  archive(value.spoke, value.normal, value.angle);
}

template <class Archive>
void transfer(Archive& archive, motion::Ramp& value) CELL_RT {
  archive(value.duration, value.v0, value.v1);
  archive.choice(value.shape, VelocityProfile::ramp);
}

template <class Archive>
void transfer(Archive& archive, motion::Way& value) CELL_RT {
  archive(value.p, value.arc, value.axis, value.length, value.angle, value.cruise, value.acceleration, value.share,
          value.t);
}

template <class Archive>
void transfer(Archive& archive, motion::MotionState& value) CELL_RT {
  archive(value.moving, value.running, value.finished, value.finished_from);
  archive.bounded(value.waiting, motion::kMoveQueue);
  archive.choice(value.outcome, motion::Outcome::blocked);
  archive(value.finished_time, value.pace);
}

template <class Archive>
void transfer(Archive& archive, HapticSample& value) CELL_RT {
  archive(value.sequence, value.writes, value.time, value.writer, value.valid, value.buttons, value.p_DH, value.q_DH,
          value.gripper, value.axes);
  archive.bounded(value.axis_count, kMaxHapticAxes);
}

template <class Archive>
void transfer(Archive& archive, HapticState& value) CELL_RT {
  archive.choice(value.phase, HapticPhase::faulted);
  archive.choice(value.fault, HapticFault::not_passive);
  archive.choice(value.awaited, HapticAwaited::rest);
  archive(value.slot, value.awaits_surroundings, value.device_sequence, value.device_writer, value.device_time,
          value.buttons, value.samples, value.skipped, value.torn, value.faults, value.resets, value.re_engagements,
          value.saturated, value.x_device, value.x_proxy, value.force_W, value.force_E, value.axis_torque,
          value.joint_torques, value.contacts, value.appeared, value.energy, value.passivity_damping, value.model_time,
          value.tissue_force_W, value.tissue_time, value.tissue_contacts, value.tissue_held, value.tissue_late,
          value.tissue_refused);
}

template <class Archive>
void transfer(Archive& archive, haptics::ContactConstraint& value) CELL_RT {
  archive(value.a, value.gap, value.normal, value.point);
}

template <class Archive>
void transfer(Archive& archive, haptics::ContactModel& value) CELL_RT {
  archive(value.sequence, value.posture_time, value.slot, value.certain, value.cell, value.x_ref, value.q, value.reach);
  archive.bounded(value.joint_count, kMaxJointsPerRobot);
  archive.bounded(value.count, haptics::kMaxConstraints);
  archive.first(value.constraints, value.count);
}

template <class Archive>
void transfer(Archive& archive, haptics::TissueForce& value) CELL_RT {
  archive(value.sequence, value.posture_time, value.slot, value.x_ref, value.force_W, value.torque_W, value.stiffness,
          value.contacts, value.held);
}

template <class Archive>
void transfer(Archive& archive, haptics::HapticSettings& value) CELL_RT {
  archive.choice(value.drive, haptics::Drive::joints);
  archive.choice(value.profile, haptics::HapticProfile::strict);
  archive(value.X_WD, value.workspace_scale, value.force_scale, value.clutch_button, value.gripper_joint,
          value.gripper_scale, value.gripper_offset, value.stiffness, value.damping, value.static_friction,
          value.dynamic_friction, value.max_force, value.max_slew, value.max_speed, value.engage_time,
          value.stale_after, value.model_stale_after, value.allowed_missed_periods, value.re_engage,
          value.passivity_control, value.energy_allowance, value.max_passivity_damping);
}

template <class Archive>
void transfer(Archive& archive, haptics::TipTarget& value) CELL_RT {
  archive(value.x_WE, value.R_WE, value.q, value.p_handle);
}

template <class Archive>
void transfer(Archive& archive, haptics::Posture& value) CELL_RT {
  archive(value.q, value.X_WE);
}

template <class Archive>
void transfer(Archive& archive, haptics::TissueReaction& value) CELL_RT {
  archive(value.force_W, value.axis_torque, value.stored);
}

template <class Archive>
void transfer(Archive& archive, HapticOutput& value) CELL_RT {
  archive(value.sequence, value.time, value.period, value.answers, value.phase, value.fault, value.force_E,
          value.force_D, value.torque_D, value.gripper_torque, value.joint_count, value.joint_torques, value.max_force);
}

// Of the first `joints` joints.
template <class Archive>
void transfer_sample(Archive& archive, JointSample& value, std::size_t joints) CELL_RT {
  archive(value.receive_time, value.source_time, value.sequence, value.present, value.refused, value.conflict);
  archive.first(value.position, joints);
  archive.first(value.velocity, joints);
  archive.first(value.effort, joints);
}

// The state of a robot in parts that change together. The first kRobotHeadParts are of the robot, the others a value of
// each of its joints. Part 0 comes first: it has their number.
inline constexpr std::size_t kRobotHeadParts = 5;
inline constexpr std::size_t kRobotStateParts = 11;
inline constexpr std::size_t kMostPartBytes = 8 * kMaxJointsPerRobot;

template <class Archive>
void transfer_part(Archive& archive, engine::RobotTickState& value, std::size_t part) CELL_RT {
  const std::size_t joints = value.joint_count;
  switch (part) {
    case 0:
      archive.choice(value.mode, engine::RobotMode::mirrored);
      archive.bounded(value.joint_count, kMaxJointsPerRobot);
      return;
    case 1:
      archive.choice(value.state, DataState::conflict);
      archive(value.sequence, value.receive_time, value.samples);
      return;
    case 2:
      archive(value.refused_values, value.implausible_values, value.conflicting_values, value.refused_setpoints);
      archive.choice(value.newest_implausible.why, Implausibility::frozen);
      archive(value.newest_implausible.joint, value.newest_implausible.value, value.newest_implausible.bound,
              value.newest_implausible.receive_time);
      return;
    case 3:
      return archive(value.motion);
    case 4:
      return archive(value.follow.master, value.follow.holding, value.follow.joints, value.follow.limited);
    case 5:
      for (std::size_t i = 0; i < joints; ++i) archive(value.joints[i].position);
      return;
    case 6:
      for (std::size_t i = 0; i < joints; ++i) archive(value.joints[i].velocity);
      return;
    case 7:
      for (std::size_t i = 0; i < joints; ++i) archive(value.joints[i].effort);
      return;
    case 8:
      for (std::size_t i = 0; i < joints; ++i) archive(value.joints[i].receive_time);
      return;
    case 9:
      for (std::size_t i = 0; i < joints; ++i) archive(value.joints[i].source_time);
      return;
    case 10:
      for (std::size_t i = 0; i < joints; ++i) {
        archive.choice(value.joints[i].state, DataState::conflict);
        archive.choice(value.joints[i].implausible, Implausibility::frozen);
      }
      return;
    default:
      return;
  }
}

template <class Archive>
void transfer_state(Archive& archive, engine::RobotTickState& value) CELL_RT {
  for (std::size_t part = 0; part < kRobotStateParts; ++part) transfer_part(archive, value, part);
}

}  // namespace cellmirror
