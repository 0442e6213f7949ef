#include "rt_core/cell/compiled_cell.hpp"

#include <algorithm>

#include "rt_core/base/contract.hpp"
#include "rt_core/kinematics/joint_motion.hpp"

namespace cellmirror {

Pose joint_motion(JointKind kind, const Eigen::Vector3d& axis, double position) CELL_RT {
  Pose X = Pose::Identity();
  kinematics::apply_joint(kind, axis, position, X);
  return X;
}

const CompiledRobot* CompiledCell::robot(std::size_t slot) const {
  if (slot >= robot_of_slot.size() || robot_of_slot[slot] < 0) return nullptr;
  return &robots[static_cast<std::size_t>(robot_of_slot[slot])];
}

void compute_poses(const CompiledCell& cell, std::span<const JointValues> q, CellPoses& poses) {
  if (poses.revision != cell.revision || poses.X_WN.size() != cell.size()) {
    poses.X_WN.resize(cell.size());
    std::copy_n(cell.X_WN_fixed.begin(), cell.fixed_count, poses.X_WN.begin());
    poses.revision = cell.revision;
  }
  for (std::size_t i = cell.fixed_count; i < cell.size(); ++i) {
    const Pose& X_WP = poses.X_WN[static_cast<std::size_t>(cell.parent[i])];
    Pose& X_WN = poses.X_WN[i];
    X_WN.affine().noalias() = X_WP.linear() * cell.X_PF[i].affine();
    X_WN.translation() += X_WP.translation();
    X_WN.makeAffine();
    if (cell.joint_of[i] < 0) continue;
    const CompiledJoint& joint = cell.joints[static_cast<std::size_t>(cell.joint_of[i])];
    CELLMIRROR_EXPECTS(joint.slot < q.size());
    const double position = joint.multiplier * q[joint.slot][joint.joint] + joint.offset;
    kinematics::apply_joint(joint.kind, joint.axis, position, X_WN);
  }
}

TcpPoses tcp_poses(const CompiledRobot& robot, const CellPoses& poses) CELL_RT {
  const auto at = [&](std::int32_t node) -> const Pose& { return poses.X_WN[static_cast<std::size_t>(node)]; };
  TcpPoses tcp;
  tcp.X_WT = at(robot.flange) * robot.X_FT;
  tcp.X_BT = at(robot.base).inverse() * tcp.X_WT;
  tcp.X_ZT = at(robot.zero_point).inverse() * tcp.X_WT;
  return tcp;
}

}  // namespace cellmirror
