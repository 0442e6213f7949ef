#include "rt_core/kinematics/forward.hpp"

#include <array>
#include <cmath>

namespace cellmirror::kinematics {

namespace {

// X_PJ followed by the joint's own motion about or along z.
Pose moved(const ChainJoint& joint, double value) CELL_RT {
  Pose X = joint.X_PJ;
  if (joint.kind == JointKind::prismatic) {
    X.translation() += value * X.linear().col(2);
    return X;
  }
  const double c = std::cos(value);
  const double s = std::sin(value);
  const Eigen::Vector3d x = X.linear().col(0);
  const Eigen::Vector3d y = X.linear().col(1);
  X.linear().col(0) = c * x + s * y;
  X.linear().col(1) = c * y - s * x;
  return X;
}

}  // namespace

Pose forward(const Chain& chain, std::span<const double> q) CELL_RT {
  Pose X_BJ = Pose::Identity();
  for (const ChainJoint& joint : chain.joints()) {
    X_BJ = X_BJ * moved(joint, joint.multiplier * q[joint.variable] + joint.offset);
  }
  return X_BJ * chain.X_LT();
}

Pose forward(const Chain& chain, std::span<const double> q, Jacobian& jacobian) CELL_RT {
  std::array<Eigen::Vector3d, kMaxChainJoints> axes;
  std::array<Eigen::Vector3d, kMaxChainJoints> origins;
  Pose X_BJ = Pose::Identity();
  std::size_t i = 0;
  for (const ChainJoint& joint : chain.joints()) {
    X_BJ = X_BJ * moved(joint, joint.multiplier * q[joint.variable] + joint.offset);
    axes[i] = X_BJ.linear().col(2);
    origins[i] = X_BJ.translation();
    ++i;
  }
  const Pose X_BT = X_BJ * chain.X_LT();
  jacobian.setZero(6, static_cast<Eigen::Index>(chain.variable_count()));
  i = 0;
  for (const ChainJoint& joint : chain.joints()) {
    auto column = jacobian.col(joint.variable);
    if (joint.kind == JointKind::prismatic) {
      column.head<3>() += joint.multiplier * axes[i];
    } else {
      column.head<3>() += joint.multiplier * axes[i].cross(X_BT.translation() - origins[i]);
      column.tail<3>() += joint.multiplier * axes[i];
    }
    ++i;
  }
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
