#include "rt_core/kinematics/forward.hpp"

#include "rt_core/base/contract.hpp"

namespace cellmirror::kinematics {

Pose forward(const Chain& chain, std::span<const double> q) CELL_RT {
  CELLMIRROR_EXPECTS(q.size() >= chain.variable_count());
  Pose X_BT;
  chain.forward_constants().pose(chain.forward_constants(), q.data(), X_BT.data(), nullptr);
  return X_BT;
}

Pose forward(const Chain& chain, std::span<const double> q, Jacobian& jacobian) CELL_RT {
  CELLMIRROR_EXPECTS(q.size() >= chain.variable_count());
  jacobian.resize(6, static_cast<Eigen::Index>(chain.variable_count()));
  Pose X_BT;
  chain.forward_constants().pose_and_jacobian(chain.forward_constants(), q.data(), X_BT.data(), jacobian.data());
  return X_BT;
}

Twist pose_error(const Pose& X_BT, const Pose& X_BG) CELL_RT {
  const Eigen::AngleAxisd rotation(Eigen::Matrix3d(X_BG.linear() * X_BT.linear().transpose()));
  Twist error;
  error.head<3>() = X_BG.translation() - X_BT.translation();
  error.tail<3>() = rotation.angle() * rotation.axis();
  return error;
}

}  // namespace cellmirror::kinematics
