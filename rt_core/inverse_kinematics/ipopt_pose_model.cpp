#include "rt_core/inverse_kinematics/ipopt_pose_model.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace cellmirror::inverse_kinematics {

using kinematics::OrientationTask;

namespace {

constexpr double kSmallAngle = 1e-4;  // rad; below it series replace quotients of vanishing numbers

Eigen::Matrix3d cross_matrix(const Eigen::Vector3d& a) {
  Eigen::Matrix3d m;
  m << 0, -a.z(), a.y(), a.z(), 0, -a.x(), -a.y(), a.x(), 0;
  return m;
}

// Hessian of angle^2 / 2 in the rotation vector of a turn on the left: the symmetric part of the inverse left Jacobian
// of SO(3). Sola et al., A micro Lie theory, (146).
PoseFunction squared_full_rotation(const Eigen::Vector3d& error) {
  PoseFunction f;
  const double angle = error.norm();
  const double half = 0.5 * angle;
  const double c = angle < kSmallAngle ? 1.0 / 12.0 : (1.0 - half * std::cos(half) / std::sin(half)) / (angle * angle);
  const Eigen::Matrix3d cross = cross_matrix(error);
  f.value = 0.5 * error.squaredNorm();
  f.w = -error;
  f.ww = Eigen::Matrix3d::Identity() + c * (cross * cross);
  return f;
}

// The same for the angle between two axes, a of the tool and its target b: along the arc the angle changes by one,
// across it the great circles converge (angle * cot(angle)), about a nothing changes.
PoseFunction squared_axis_rotation(const Eigen::Vector3d& a, const Eigen::Vector3d& error) {
  PoseFunction f;
  const double angle = error.norm();
  f.value = 0.5 * angle * angle;
  f.w = -error;
  if (angle < kSmallAngle) {
    f.ww = Eigen::Matrix3d::Identity() - a * a.transpose() - 0.5 * (a * a.cross(error).transpose());
    f.ww = 0.5 * (f.ww + f.ww.transpose()).eval();
    return f;
  }
  const Eigen::Vector3d u = error / angle;
  const Eigen::Vector3d v = u.cross(a);
  const double across = std::max(angle * std::cos(angle) / std::sin(angle), -1.0);  // unbounded towards pi
  f.ww = u * u.transpose() + across * (v * v.transpose()) - 0.5 * angle * (a * v.transpose() + v * a.transpose());
  return f;
}

}  // namespace

int tool_axis_of(OrientationTask orientation) {
  switch (orientation) {
    case OrientationTask::normal:
      return 0;
    case OrientationTask::sliding:
      return 1;
    case OrientationTask::approach:
      return 2;
    case OrientationTask::free:
    case OrientationTask::full:
      break;
  }
  return -1;
}

PoseFunction& PoseFunction::operator+=(const PoseFunction& other) {
  value += other.value;
  p += other.p;
  w += other.w;
  pp += other.pp;
  ww += other.ww;
  return *this;
}

PoseFunction& PoseFunction::operator*=(double factor) {
  value *= factor;
  p *= factor;
  w *= factor;
  pp *= factor;
  ww *= factor;
  return *this;
}

void PoseModel::place(std::span<const double> q) {
  if (placed_ && std::equal(q.begin(), q.end(), q_.begin())) return;
  std::copy(q.begin(), q.end(), q_.begin());
  placed_ = true;
  std::array<Eigen::Vector3d, kinematics::kMaxChainJoints> origins;
  Eigen::Matrix3d R = Eigen::Matrix3d::Identity();
  Eigen::Vector3d p = Eigen::Vector3d::Zero();
  std::size_t k = 0;
  for (const kinematics::ChainJoint& joint : chain_.joints()) {
    const double value = joint.multiplier * q[joint.variable] + joint.offset;
    p += R * joint.X_PJ.translation();
    R = R * joint.X_PJ.linear();
    const Eigen::Vector3d z = R.col(2);
    Column& column = columns_[k];
    column.variable = joint.variable;
    if (joint.kind == JointKind::prismatic) {
      p += value * z;
      column.v = joint.multiplier * z;
      column.w.setZero();
    } else {
      const double c = std::cos(value);
      const double s = std::sin(value);
      const Eigen::Vector3d x = R.col(0);
      const Eigen::Vector3d y = R.col(1);
      R.col(0) = c * x + s * y;
      R.col(1) = c * y - s * x;
      column.w = joint.multiplier * z;
    }
    origins[k] = p;
    ++k;
  }
  p += R * chain_.X_LT().translation();
  X_BT_.linear() = R * chain_.X_LT().linear();
  X_BT_.translation() = p;
  k = 0;
  for (const kinematics::ChainJoint& joint : chain_.joints()) {
    if (joint.kind != JointKind::prismatic) columns_[k].v = columns_[k].w.cross(p - origins[k]);
    ++k;
  }
}

void PoseModel::add_gradient(const PoseFunction& function, Gradient& gradient) const {
  for (std::size_t k = 0; k < chain_.joints().size(); ++k) {
    const Column& column = columns_[k];
    gradient[column.variable] += function.p.dot(column.v) + function.w.dot(column.w);
  }
}

// For joints j before i along the chain: d2p / dqi dqj = w_j x v_i, and turning by w_i dqi, then by w_j dqj is turning
// by w_i dqi + w_j dqj + (w_j x w_i) dqi dqj / 2 + ...
void PoseModel::add_hessian(const PoseFunction& function, bool curvature, Hessian& hessian) const {
  for (std::size_t i = 0; i < chain_.joints().size(); ++i) {
    const Column& ci = columns_[i];
    const Eigen::Vector3d pp_v = function.pp * ci.v;
    const Eigen::Vector3d ww_w = function.ww * ci.w;
    Eigen::Vector3d bend = Eigen::Vector3d::Zero();
    if (curvature) bend = ci.v.cross(function.p) + 0.5 * ci.w.cross(function.w);
    for (std::size_t j = 0; j <= i; ++j) {
      const Column& cj = columns_[j];
      const double h = pp_v.dot(cj.v) + ww_w.dot(cj.w) + bend.dot(cj.w);
      const int row = std::max(ci.variable, cj.variable);
      const int column = std::min(ci.variable, cj.variable);
      hessian(row, column) += i != j && row == column ? 2.0 * h : h;
    }
  }
}

PoseFunction squared_task_error(const kinematics::Task& task, const Pose& X_BT, const Pose& X_BG,
                                double position_weight) {
  PoseFunction f;
  const Eigen::Vector3d error = X_BT.translation() - X_BG.translation();
  for (int axis = 0; axis < 3; ++axis) {
    if (((task.position_axes >> axis) & 1) == 0) continue;
    f.value += 0.5 * position_weight * error[axis] * error[axis];
    f.p[axis] = position_weight * error[axis];
    f.pp(axis, axis) = position_weight;
  }
  if (task.orientation_required) f += squared_orientation_error(task, X_BT, X_BG);
  return f;
}

PoseFunction squared_orientation_error(const kinematics::Task& task, const Pose& X_BT, const Pose& X_BG) {
  if (task.orientation == OrientationTask::free) return {};
  kinematics::Task all = task;
  all.orientation_required = true;
  const kinematics::Twist error = kinematics::task_error(all, X_BT, X_BG);
  if (task.orientation == OrientationTask::full) return squared_full_rotation(error.tail<3>());
  return squared_axis_rotation(X_BT.linear().col(tool_axis_of(task.orientation)), error.tail<3>());
}

}  // namespace cellmirror::inverse_kinematics
