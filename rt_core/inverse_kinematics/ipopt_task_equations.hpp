// The required components of a task as equations of a nonlinear program. Internal to the folder.
#pragma once

#include <Eigen/Core>
#include <array>

#include "rt_core/base/pose.hpp"
#include "rt_core/inverse_kinematics/ipopt_pose_model.hpp"
#include "rt_core/kinematics/task.hpp"

namespace cellmirror::inverse_kinematics {

// Equations c = 0. For orientations the sine of the error's angle, which has simple second derivatives; so they hold
// near the solution only (the opposite orientation meets them as well).
class TaskEquations {
 public:
  static constexpr int kMost = 6;

  TaskEquations() = default;
  TaskEquations(const kinematics::Task& task, const Pose& X_BG);

  // Omits the equations that depend on others, or that nothing can change, at the model's posture: a planar arm cannot
  // miss the height of its plane.
  void keep_independent(const PoseModel& model);

  [[nodiscard]] int count() const { return count_; }
  // count() values; m, and sines.
  void values(const Pose& X_BT, double* c) const;
  // Equation `row` as a function of the pose.
  [[nodiscard]] PoseFunction one(const Pose& X_BT, int row) const;
  // The sum of multipliers[i] * c[i].
  [[nodiscard]] PoseFunction combined(const Pose& X_BT, const double* multipliers) const;

 private:
  // 0..2: axis of the position; 3..5: component of the orientation's sine; see the constructor.
  std::array<int, kMost> row_{};
  int count_ = 0;
  int tool_axis_ = -1;
  Pose X_BG_ = Pose::Identity();
  Eigen::Matrix3d across_ = Eigen::Matrix3d::Zero();
};

}  // namespace cellmirror::inverse_kinematics
