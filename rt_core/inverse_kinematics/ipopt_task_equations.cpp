#include "rt_core/inverse_kinematics/ipopt_task_equations.hpp"

#include <Eigen/Geometry>
#include <algorithm>

namespace cellmirror::inverse_kinematics {

// Rows 3..5 are the sine's three components (half the sum of the cross products of target's and tool's axes), or rows 3
// and 4 the components of the tool's axis along the target's other two.
TaskEquations::TaskEquations(const kinematics::Task& task, const Pose& X_BG) : X_BG_(X_BG) {
  for (int axis = 0; axis < 3; ++axis) {
    if (((task.position_axes >> axis) & 1) != 0) row_[static_cast<std::size_t>(count_++)] = axis;
  }
  if (!task.orientation_required || task.orientation == kinematics::OrientationTask::free) return;
  tool_axis_ = tool_axis_of(task.orientation);
  const int rotations = tool_axis_ < 0 ? 3 : 2;
  for (int k = 0; k < rotations; ++k) row_[static_cast<std::size_t>(count_++)] = 3 + k;
  if (tool_axis_ < 0) return;
  across_.col(0) = X_BG.linear().col((tool_axis_ + 1) % 3);
  across_.col(1) = X_BG.linear().col((tool_axis_ + 2) % 3);
}

void TaskEquations::keep_independent(const PoseModel& model) {
  constexpr double kDependent = 1e-6;  // m or sine a rad (or m)
  std::array<Gradient, kMost> basis;   // orthonormal; Gram-Schmidt in the order of the rows
  int kept = 0;
  for (int i = 0; i < count_; ++i) {
    Gradient rest = Gradient::Zero(static_cast<Eigen::Index>(model.chain().variable_count()));
    model.add_gradient(one(model.X_BT(), i), rest);
    for (std::size_t v = 0; v < model.chain().variable_count(); ++v) {
      if (model.chain().lower()[v] == model.chain().upper()[v]) rest[static_cast<Eigen::Index>(v)] = 0.0;
    }
    for (int j = 0; j < kept; ++j) {
      const Gradient& b = basis[static_cast<std::size_t>(j)];
      rest -= b.dot(rest) * b;
    }
    const double length = rest.norm();
    if (!(length > kDependent)) continue;
    basis[static_cast<std::size_t>(kept)] = rest / length;
    row_[static_cast<std::size_t>(kept++)] = row_[static_cast<std::size_t>(i)];
  }
  count_ = kept;
}

void TaskEquations::values(const Pose& X_BT, double* c) const {
  for (int i = 0; i < count_; ++i) c[i] = one(X_BT, i).value;
}

PoseFunction TaskEquations::one(const Pose& X_BT, int row) const {
  std::array<double, kMost> unit{};
  unit[static_cast<std::size_t>(row)] = 1.0;
  return combined(X_BT, unit.data());
}

PoseFunction TaskEquations::combined(const Pose& X_BT, const double* multipliers) const {
  PoseFunction f;
  Eigen::Vector3d lambda = Eigen::Vector3d::Zero();
  for (int i = 0; i < count_; ++i) {
    const int row = row_[static_cast<std::size_t>(i)];
    if (row < 3) {
      f.p[row] = multipliers[i];
      f.value += multipliers[i] * (X_BT.translation()[row] - X_BG_.translation()[row]);
    } else {
      lambda[row - 3] = multipliers[i];
    }
  }
  // The orientation's part is a sum of m . r over axes r of the tool with constant vectors m; n is the sum of m r^T.
  Eigen::Matrix3d n = Eigen::Matrix3d::Zero();
  if (tool_axis_ >= 0) {
    n = (across_ * lambda) * X_BT.linear().col(tool_axis_).transpose();
  } else {
    for (int k = 0; k < 3; ++k) {
      const Eigen::Vector3d g = X_BG_.linear().col(k);
      n += 0.5 * lambda.cross(g) * X_BT.linear().col(k).transpose();
    }
  }
  f.value += n.trace();
  f.w = Eigen::Vector3d(n(2, 1) - n(1, 2), n(0, 2) - n(2, 0), n(1, 0) - n(0, 1));  // sum of r x m
  f.ww = 0.5 * (n + n.transpose()) - n.trace() * Eigen::Matrix3d::Identity();
  return f;
}

}  // namespace cellmirror::inverse_kinematics
