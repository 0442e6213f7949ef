// What goes into a step of the simulation, and what instruments feel of it.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>

#include "rt_core/base/pose.hpp"
#include "rt_core/base/time.hpp"
#include "rt_core/tissue/description/rigid_body.hpp"

namespace cellmirror::tissue {

inline constexpr double kStep_s = 0.001;

// An instrument in this step.
struct InstrumentPose {
  int slot = 0;                  // of its robot
  Pose X_WT = Pose::Identity();  // tool centre point, z forwards along the shaft, y the direction in which jaws open
  std::span<const double> q;     // rad or m, all joints
};

struct StepInput {
  Timestamp time;
  std::span<const InstrumentPose> instruments;
  std::span<const RigidBodyPose> bodies;
};

// Force of the tissue on an instrument near the pose for which it was computed: F(x) = force - stiffness (x - x_ref),
// for the tool centre point at x. A stiffness is symmetric and never negative; while nothing is held, a force never
// pulls the instrument into the tissue.
struct InstrumentResponse {
  int slot = 0;
  Eigen::Vector3d x_ref = Eigen::Vector3d::Zero();      // m, world
  Eigen::Vector3d force_W = Eigen::Vector3d::Zero();    // N, equivalent at the tool centre point
  Eigen::Vector3d torque_W = Eigen::Vector3d::Zero();   // Nm about the tool centre point
  Eigen::Matrix3d stiffness = Eigen::Matrix3d::Zero();  // N/m
  std::uint32_t contacts = 0;
  std::uint32_t held = 0;
};

}  // namespace cellmirror::tissue
