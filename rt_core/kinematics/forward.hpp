// Forward kinematics and the geometric Jacobian of a chain.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>

#include "rt_core/base/contract.hpp"
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

// The same with a Jacobian of fixed size, for loops over chains whose number of variables is known.
template <int N>
[[nodiscard]] Pose forward(const Chain& chain, std::span<const double, static_cast<std::size_t>(N)> q,
                           Eigen::Matrix<double, 6, N>& jacobian) CELL_RT {
  CELLMIRROR_EXPECTS(chain.variable_count() == static_cast<std::size_t>(N));
  Pose X_BT;
  chain.forward_constants().pose_and_jacobian(chain.forward_constants(), q.data(), X_BT.data(), jacobian.data());
  return X_BT;
}

// The displacement that leads from pose `X_BT` to `X_BG`: the difference of the origins, and the rotation vector of
// R_BG R_BT^T (angle within [0, pi]), both expressed in the base.
[[nodiscard]] Twist pose_error(const Pose& X_BT, const Pose& X_BG) CELL_RT;

}  // namespace cellmirror::kinematics
