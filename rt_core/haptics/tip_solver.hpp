// The posture of an instrument for a tip position: position first, orientation with the remaining freedom. An
// instrument of four joints through a trocar has its roll left.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>

#include "rt_core/base/pose.hpp"
#include "rt_core/base/real_time.hpp"
#include "rt_core/kinematics/chain.hpp"
#include "rt_core/kinematics/forward.hpp"

namespace cellmirror::haptics {

// m2: of inverses of J_v J_v^T, far below what a lever of a millimetre gives.
inline constexpr double kPlaceDamping = 1e-10;

struct TipGoal {
  Eigen::Vector3d p_BE = Eigen::Vector3d::Zero();      // m, in the base
  Eigen::Matrix3d R_BE = Eigen::Matrix3d::Identity();  // attempted
  bool orient = true;
};

// What may move, a value a variable of the chain.
struct TipFreedom {
  std::span<const double> lower;  // rad or m
  std::span<const double> upper;
  std::uint32_t fixed = 0;  // bit i: variable i stays as it is
};

struct TipPosture {
  Pose X_BE = Pose::Identity();
  kinematics::Jacobian J;  // geometric, in the base
  double error = 0;        // m, from the requested position
  bool met = false;        // within a micrometre
};

// Newton's steps from q, by damped pseudoinverses in order of priority (Siciliano et al., Robotics, 3.5.1), inside the
// limits; q is left at the posture whose tip was nearest. At most 8 iterations. No heap.
TipPosture solve_tip(const kinematics::Chain& chain, const TipGoal& goal, const TipFreedom& freedom,
                     std::span<double> q) CELL_RT;

}  // namespace cellmirror::haptics
