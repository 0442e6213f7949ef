// The chain at one posture with its first and second derivatives, and the functions of the pose that the nonlinear
// programs are made of. No Ipopt in here.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <span>

#include "rt_core/base/pose.hpp"
#include "rt_core/kinematics/chain.hpp"
#include "rt_core/kinematics/task.hpp"

namespace cellmirror::inverse_kinematics {

inline constexpr int kVariables = static_cast<int>(kinematics::kMaxVariables);
using Gradient = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kVariables, 1>;
using Hessian = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kVariables, kVariables>;

// A function of the pose of the tip to second order: moving the tip's origin by d (m) and then turning it by the
// rotation vector r (rad), both expressed in the base, changes the function by
//   p.d + w.r + (d.pp.d + r.ww.r) / 2 + ...
// pp and ww are symmetric.
struct PoseFunction {
  double value = 0.0;
  Eigen::Vector3d p = Eigen::Vector3d::Zero();
  Eigen::Vector3d w = Eigen::Vector3d::Zero();
  Eigen::Matrix3d pp = Eigen::Matrix3d::Zero();
  Eigen::Matrix3d ww = Eigen::Matrix3d::Zero();

  PoseFunction& operator+=(const PoseFunction& other);
  PoseFunction& operator*=(double factor);
};

class PoseModel {
 public:
  explicit PoseModel(const kinematics::Chain& chain) : chain_(chain) {}

  // rad or m, one value a variable. Does nothing if they are those of the last call.
  void place(std::span<const double> q);

  [[nodiscard]] const kinematics::Chain& chain() const { return chain_; }
  [[nodiscard]] const Pose& X_BT() const { return X_BT_; }

  // Add to what is there; sized by the caller.
  void add_gradient(const PoseFunction& function, Gradient& gradient) const;
  // Lower triangle only. `curvature`: false leaves out the second derivatives of the pose itself (Gauss-Newton).
  void add_hessian(const PoseFunction& function, bool curvature, Hessian& hessian) const;

 private:
  // What one unit of a joint's velocity does to the tip, expressed in the base.
  struct Column {
    Eigen::Vector3d v;
    Eigen::Vector3d w;
    int variable = 0;
  };

  kinematics::Chain chain_;
  Pose X_BT_ = Pose::Identity();
  std::array<Column, kinematics::kMaxChainJoints> columns_;
  JointValues q_{};
  bool placed_ = false;
};

// weight * (p - p_G)^2 / 2 over the axes that the task names (weight in 1 / m2), and angle^2 / 2 of the orientation if
// it is required.
[[nodiscard]] PoseFunction squared_task_error(const kinematics::Task& task, const Pose& X_BT, const Pose& X_BG,
                                              double position_weight);
// angle^2 / 2 of the rotation that the task's orientation wants, whether required or not; zero for a free one.
[[nodiscard]] PoseFunction squared_orientation_error(const kinematics::Task& task, const Pose& X_BT, const Pose& X_BG);

// -1: a task without a single axis of the tool; else 0, 1, 2: its x, y, z axis.
[[nodiscard]] int tool_axis_of(kinematics::OrientationTask orientation);

}  // namespace cellmirror::inverse_kinematics
