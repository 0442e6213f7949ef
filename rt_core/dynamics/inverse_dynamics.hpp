// The forces that a motion takes: recursive Newton-Euler. Luh, Walker, Paul 1980; Featherstone, Rigid Body Dynamics
// Algorithms, 5.3.
#pragma once

#include <Eigen/Core>
#include <array>
#include <span>

#include "rt_core/base/real_time.hpp"
#include "rt_core/dynamics/mechanism.hpp"
#include "rt_core/ports/force_state.hpp"

namespace cellmirror::dynamics {

struct DynamicsInput {
  std::span<const double> q;                                    // rad or m, one a variable
  std::span<const double> qd;                                   // rad/s or m/s
  std::span<const double> qdd;                                  // rad/s2 or m/s2
  Eigen::Vector3d gravity_B = Eigen::Vector3d(0, 0, -9.80665);  // m/s2, in the robot's base, which does not accelerate
  Eigen::Vector3d tip_force_T = Eigen::Vector3d::Zero();        // N, of the surroundings on the TCP, in frame T
  Eigen::Vector3d tip_torque_T = Eigen::Vector3d::Zero();       // Nm
};

struct DynamicsOutput {
  JointValues effort{};  // Nm or N, joint side: what the drive gives, friction and rotor included
  // What the part before a joint bears there, at the joint's origin, in the joint's frame.
  std::array<Wrench, kMaxLinks> joint_wrench{};
};

// At most 1 us for six axes. No heap. Coulomb friction is smoothed around standstill (tanh over kFrictionSpeed).
inline constexpr double kFrictionSpeed = 1e-3;  // rad/s or m/s
void inverse_dynamics(const Mechanism& mechanism, const DynamicsInput& input, DynamicsOutput& output) CELL_RT;

}  // namespace cellmirror::dynamics
