// The parameters of a robot and its controller that SCRIPT sets (manual 1.2.2). Plain data, SI.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "rt_core/base/capacity.hpp"
#include "rt_core/base/pose.hpp"

namespace cellmirror {

using JointValues =
    std::array<double, kMaxJointsPerRobot>;  // rad or m (and their derivatives); the robot's first n count

enum class PtpMode : std::uint8_t { synchronous, asynchronous };
enum class VelocityProfile : std::uint8_t { sine, ramp };
enum class FlyType : std::uint8_t { speed_fraction = 0, distance = 1, angle = 2 };  // rob_cart_fly_radius 0, 1, 2

enum class InverseClass : std::uint8_t {
  align_frame,
  align_pos,
  align_x_axis,
  align_y_axis,
  align_z_axis,
  align_xy_axis,
  align_yz_axis,
  align_xz_axis,
  align_n_axis,
  align_s_axis,
  align_a_axis,
  align_xy_n_axis,
  align_xy_s_axis,
  align_xy_a_axis,
  align_xz_n_axis,
  align_xz_s_axis,
  align_xz_a_axis,
  align_yz_n_axis,
  align_yz_s_axis,
  align_yz_a_axis,
  edith,
  boom_3,
  boom_4,
  boom_5,
  boom_6,
};

// A parameter with one value a joint, or with one number (manual 1.2.2). Values arrive in SI.
enum class JointParameter : std::uint8_t {
  max_range,
  min_range,
  start_position,
  reference_position,
  max_velocity,
  min_velocity,
  active_velocity,
  max_acceleration,
  active_acceleration,
};
enum class ScalarParameter : std::uint8_t {
  linear_velocity,
  linear_acceleration,
  rotational_velocity,
  rotational_acceleration,
  velocity_scale,
  acceleration_scale,
  program_delay,
};

// What was asked for, of the parameters that others limit: what is in force may be less.
struct RequestedParameters {
  JointValues start_position{};
  JointValues active_velocity{};
  JointValues active_acceleration{};
};

struct RobotParameters {
  // Joint space. Positions rad or m; velocities rad/s or m/s; accelerations rad/s2 or m/s2.
  JointValues max_range{};
  JointValues min_range{};
  JointValues start_position{};  // in force: the requested one, limited to the range
  JointValues reference_position{};
  JointValues max_velocity{};
  JointValues min_velocity{};
  JointValues active_velocity{};  // in force until a program sets one: the requested one, at most the maximum
  JointValues max_acceleration{};
  JointValues active_acceleration{};  // likewise
  // Cartesian space.
  double linear_velocity = 1.0;           // m/s
  double linear_acceleration = 2.0;       // m/s2
  double rotational_velocity = 3.14;      // rad/s
  double rotational_acceleration = 6.28;  // rad/s2
  double velocity_scale = 1.0;            // 0.01..1
  double acceleration_scale = 1.0;        // 0.01..1
  FlyType fly_type = FlyType::distance;
  double fly_parameter = 0.0;  // fraction 0..1, m, or rad, by fly_type
  double program_delay_s = 0.0;
  PtpMode ptp_mode = PtpMode::synchronous;
  VelocityProfile velocity_profile = VelocityProfile::sine;
  InverseClass inverse_class = InverseClass::align_frame;
  Pose X_FP = Pose::Identity();  // point of reference in the flange (rob_por_def)
  Pose X_PT = Pose::Identity();  // tool centre point in the point of reference (rob_tcp_def)
  RequestedParameters requested;
};

}  // namespace cellmirror
