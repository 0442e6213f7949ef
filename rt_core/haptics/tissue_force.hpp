// Force of soft tissue on an instrument near the posture for which a worker computed it. Fixed size, so that it crosses
// threads in a Latest. World frame, SI.
#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "rt_core/base/time.hpp"

namespace cellmirror::haptics {

// For the tool centre point at x: F(x) = force_W - stiffness (x - x_ref). Where the worker smooths the force over some
// steps it smooths x_ref likewise, so that both are of one instant: a force that lags behind its place gives energy.
struct TissueForce {
  std::uint64_t sequence = 0;                           // counted by the worker, from 1
  Timestamp posture_time;                               // of the tick whose posture it was computed for
  std::uint8_t slot = 0;                                // of the instrument's robot
  Eigen::Vector3d x_ref = Eigen::Vector3d::Zero();      // m, the tool centre point in that posture
  Eigen::Vector3d force_W = Eigen::Vector3d::Zero();    // N, sum of the forces on the instrument
  Eigen::Vector3d torque_W = Eigen::Vector3d::Zero();   // Nm, of the same about the tool centre point
  Eigen::Matrix3d stiffness = Eigen::Matrix3d::Zero();  // N/m, symmetric, positive semi-definite
  std::uint32_t contacts = 0;                           // places where it touches
  std::uint32_t held = 0;                               // places that its jaws hold: only then a force may pull inwards
};

}  // namespace cellmirror::haptics
