#include "rt_core/contact_model/levers.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>

namespace cellmirror::contact_model {

namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

// Directions in which the tip moves less than this part of the best one count as those in which it cannot move. A
// radian and a metre weigh the same here, and an instrument that is 10 mm deep still moves sideways.
constexpr double kLeastMotion = 1e-3;

const Matrix3d kZero = Matrix3d::Zero();

}  // namespace

void Levers::adopt(const CompiledCell& cell, const CompiledRobot& robot) {
  joints_.clear();
  above_.assign(cell.size(), {});
  // Parents come before their children.
  for (std::size_t node = 1; node < cell.size(); ++node) {
    above_[node] = above_[static_cast<std::size_t>(cell.parent[node])];
    if (cell.joint_of[node] < 0) continue;
    const CompiledJoint& joint = cell.joints[static_cast<std::size_t>(cell.joint_of[node])];
    if (joint.slot != robot.slot) continue;
    above_[node].push_back(static_cast<std::uint32_t>(joints_.size()));
    MovingJoint moving;
    moving.node = static_cast<std::int32_t>(node);
    moving.kind = joint.kind;
    moving.joint = joint.joint;
    moving.multiplier = joint.multiplier;
    moving.axis = joint.axis;
    joints_.push_back(moving);
  }
  affine_.assign(joints_.size(), {});
  flange_ = robot.flange;
  X_FT_ = robot.X_FT;
}

void Levers::move(const CellPoses& poses) {
  for (MovingJoint& joint : joints_) {
    const Pose& X_WJ = poses.X_WN[static_cast<std::size_t>(joint.node)];
    joint.axis_W = X_WJ.linear() * joint.axis;
    joint.origin_W = X_WJ.translation();
  }
  tip_ = poses.X_WN[static_cast<std::size_t>(flange_)] * X_FT_.translation();
  // Columns by joint of the robot: mimics add to their master's.
  std::array<Vector3d, kMaxJointsPerRobot> columns;
  columns.fill(Vector3d::Zero());
  for (const std::uint32_t i : joints_above(flange_)) columns[joints_[i].joint] += velocity(joints_[i], tip_);
  Matrix3d gram = Matrix3d::Zero();
  for (const Vector3d& column : columns) gram += column * column.transpose();
  const Eigen::SelfAdjointEigenSolver<Matrix3d> solver(gram);
  const Vector3d& squares = solver.eigenvalues();
  Matrix3d inverse = Matrix3d::Zero();
  for (Eigen::Index i = 0; i < 3; ++i) {
    if (!(squares[i] > kLeastMotion * kLeastMotion * squares[2]) || !(squares[i] > 0)) continue;
    const Vector3d v = solver.eigenvectors().col(i);
    inverse += v * v.transpose() / squares[i];
  }
  for (std::size_t i = 0; i < joints_.size(); ++i) {
    const MovingJoint& joint = joints_[i];
    const Eigen::RowVector3d of_tip = columns[joint.joint].transpose() * inverse;
    AffineLever& lever = affine_[i];
    const auto& above = joints_above(joint.node);  // the last is this one
    lever = above.size() > 1 ? affine_[above[above.size() - 2]] : AffineLever{Matrix3d::Zero(), {kZero, kZero, kZero}};
    lever.base += velocity(joint, Vector3d::Zero()) * of_tip;
    if (joint.kind == JointKind::prismatic) continue;
    for (Eigen::Index k = 0; k < 3; ++k) {
      lever.along[static_cast<std::size_t>(k)] += joint.multiplier * joint.axis_W.cross(Vector3d::Unit(k)) * of_tip;
    }
  }
}

Matrix3d Levers::lever(std::int32_t node, const Vector3d& p_W) const {
  const auto& above = joints_above(node);
  if (above.empty()) return Matrix3d::Zero();
  const AffineLever& lever = affine_[above.back()];
  return lever.base + p_W.x() * lever.along[0] + p_W.y() * lever.along[1] + p_W.z() * lever.along[2];
}

}  // namespace cellmirror::contact_model
