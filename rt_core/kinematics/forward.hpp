// Forward kinematics and the geometric Jacobian of a chain.
#pragma once

#include <Eigen/Core>
#include <span>

#include "rt_core/base/pose.hpp"
#include "rt_core/base/real_time.hpp"
#include "rt_core/kinematics/chain.hpp"

namespace cellmirror::kinematics {

// 6 x n. Rows 0..2: velocity of the tip's origin, rows 3..5: angular velocity, both expressed in the base; column i is
// what one unit of velocity of variable i gives. Siciliano et al., Robotics, 3.1.
using Jacobian = Eigen::Matrix<double, 6, Eigen::Dynamic, Eigen::ColMajor, 6, static_cast<int>(kMaxVariables)>;
// v (m), then w (rad); both expressed in the base.
using Twist = Eigen::Matrix<double, 6, 1>;

// The tip in the base. `q`: one value a variable, rad or m.
[[nodiscard]] Pose forward(const Chain& chain, std::span<const double> q) CELL_RT;

// The same, and the Jacobian, which is resized to 6 x variable_count().
[[nodiscard]] Pose forward(const Chain& chain, std::span<const double> q, Jacobian& jacobian) CELL_RT;

// The displacement that leads from pose `X_BT` to `X_BG`: the difference of the origins, and the rotation vector of
// R_BG R_BT^T (angle within [0, pi]), both expressed in the base.
[[nodiscard]] Twist pose_error(const Pose& X_BT, const Pose& X_BG) CELL_RT;

}  // namespace cellmirror::kinematics
