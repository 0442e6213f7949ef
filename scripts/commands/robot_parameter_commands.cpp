// Manual 1.2.2: they concern the active robot.
#include <array>

#include "rt_core/base/capacity.hpp"
#include "rt_core/base/pose.hpp"
#include "scripts/commands/registry.hpp"

namespace cellmirror::script {

namespace {

template <ScalarParameter which>
Outcome set_scalar(const ParsedCommand& command, CommandHost& host) {
  return Outcome::of(host.robots.set_scalar_parameter(which, command.number(kOnlySlot)));
}

template <JointParameter which>
Outcome set_joints(const ParsedCommand& command, CommandHost& host) {
  std::array<double, kMaxJointsPerRobot> storage;
  const std::size_t n = command.numbers(kOnlySlot, storage);
  return Outcome::with_remark(host.robots.set_joint_parameter(which, std::span(storage).first(n)));
}

Outcome set_fly(const ParsedCommand& command, CommandHost& host) {
  return Outcome::of(host.robots.set_fly(static_cast<FlyType>(command.integer(slots::fly::kType)),
                                         command.number(slots::fly::kParameter)));
}

Outcome set_ptp_mode(const ParsedCommand& command, CommandHost& host) {
  return Outcome::of(host.robots.set_ptp_mode(static_cast<PtpMode>(command.choice(kOnlySlot))));
}

Outcome set_profile(const ParsedCommand& command, CommandHost& host) {
  return Outcome::of(host.robots.set_velocity_profile(static_cast<VelocityProfile>(command.choice(kOnlySlot))));
}

Outcome set_inverse_class(const ParsedCommand& command, CommandHost& host) {
  return Outcome::of(host.robots.set_inverse_class(static_cast<InverseClass>(command.choice(kOnlySlot))));
}

// Translation first, then roll, pitch, yaw.
Pose offset(const ParsedCommand& command) {
  return pose_from_xyz_rpy(vector_at(command, slots::offset::kTranslation),
                           vector_at(command, slots::offset::kRotation));
}

Outcome set_point_of_reference(const ParsedCommand& command, CommandHost& host) {
  return Outcome::of(host.robots.set_point_of_reference(offset(command)));
}

Outcome set_tool_center_point(const ParsedCommand& command, CommandHost& host) {
  return Outcome::of(host.robots.set_tool_center_point(offset(command)));
}

// The first choice is "on".
Outcome set_arc(const ParsedCommand& command, CommandHost& host) {
  return Outcome::of(host.display.set_arc(command.choice(kOnlySlot) == 0));
}

constexpr Registration kHandlers[] = {
    {FormId::rob_cart_lin_vel, set_scalar<ScalarParameter::linear_velocity>},
    {FormId::rob_cart_lin_acc, set_scalar<ScalarParameter::linear_acceleration>},
    {FormId::rob_cart_rot_vel, set_scalar<ScalarParameter::rotational_velocity>},
    {FormId::rob_cart_rot_acc, set_scalar<ScalarParameter::rotational_acceleration>},
    {FormId::rob_cart_vel_scal, set_scalar<ScalarParameter::velocity_scale>},
    {FormId::rob_cart_acc_scal, set_scalar<ScalarParameter::acceleration_scale>},
    {FormId::rob_cart_fly_radius, set_fly},
    {FormId::rob_program_delays, set_scalar<ScalarParameter::program_delay>},
    {FormId::rob_jnt_max_range, set_joints<JointParameter::max_range>},
    {FormId::rob_jnt_min_range, set_joints<JointParameter::min_range>},
    {FormId::rob_jnt_start_pos, set_joints<JointParameter::start_position>},
    {FormId::rob_jnt_ref_pos, set_joints<JointParameter::reference_position>},
    {FormId::rob_jnt_max_vel, set_joints<JointParameter::max_velocity>},
    {FormId::rob_jnt_min_vel, set_joints<JointParameter::min_velocity>},
    {FormId::rob_jnt_act_vel, set_joints<JointParameter::active_velocity>},
    {FormId::rob_jnt_max_acc, set_joints<JointParameter::max_acceleration>},
    {FormId::rob_jnt_act_acc, set_joints<JointParameter::active_acceleration>},
    {FormId::rob_ptp_mode, set_ptp_mode},
    {FormId::rob_por_def, set_point_of_reference},
    {FormId::rob_tcp_def, set_tool_center_point},
    {FormId::rob_vel_profile, set_profile},
    {FormId::rob_inverse_class, set_inverse_class},
    {FormId::arc, set_arc},
};

}  // namespace

std::span<const Registration> robot_parameter_handlers() { return kHandlers; }

}  // namespace cellmirror::script
