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
  Eigen::Vector3d gravity_B = Eigen::Vector3d(0, 0, -9.80665);  // m/s2, in the base, which does not accelerate
  Eigen::Vector3d tip_force_T = Eigen::Vector3d::Zero();        // N, of the surroundings on the TCP, in frame T
  Eigen::Vector3d tip_torque_T = Eigen::Vector3d::Zero();       // Nm
};

struct DynamicsOutput {
  // Nm or N, joint side: what the drive gives, with the friction and the rotor that it has to overcome. A mimic's share
  // is in its variable's, times its multiplier (virtual work).
  JointValues effort{};
  // What the part before a joint gives to the part behind it, at the joint's origin, in the joint's frame: gravity
  // makes it point upwards. Without friction and rotor; its component along the axis is the effort of the bare link.
  std::array<Wrench, kMaxLinks> joint_wrench{};
};

// Coulomb friction is smoothed around standstill: tanh(velocity / kFrictionSpeed). A motor's rotor counts by its
// reflected inertia; that it turns with its link besides (gyroscopic torque) is left out.
inline constexpr double kFrictionSpeed = 1e-3;  // rad/s or m/s

// `output` is written for the variables and links of the mechanism; the rest of it is left as it is. About 0.3 us for
// six axes; no heap.
void inverse_dynamics(const Mechanism& mechanism, const DynamicsInput& input, DynamicsOutput& output) CELL_RT;

// The drive's own part of the effort: friction and rotor.
[[nodiscard]] double drive_effort(const Drive& drive, double qd, double qdd) CELL_RT;

}  // namespace cellmirror::dynamics
