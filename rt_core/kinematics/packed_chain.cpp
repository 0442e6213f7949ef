#include "rt_core/kinematics/packed_chain.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace cellmirror::kinematics {

namespace {

// R = Rz(first) Rx(middle) Rz(last).
struct EulerZxz {
  double first = 0;
  double cos_middle = 1;
  double sin_middle = 0;
  double last = 0;
};

EulerZxz euler_zxz(const Eigen::Matrix3d& R) CELL_RT {
  EulerZxz angles;
  angles.sin_middle = std::hypot(R(0, 2), R(1, 2));
  const double norm = std::hypot(angles.sin_middle, R(2, 2));
  angles.sin_middle /= norm;
  angles.cos_middle = R(2, 2) / norm;
  angles.first = std::atan2(R(0, 2), -R(1, 2));
  // Rz(last) is what is left; so a middle angle near 0 or pi costs no accuracy.
  const double c = std::cos(angles.first);
  const double s = std::sin(angles.first);
  const Eigen::Vector3d x = R.col(0);
  const double x_turned = c * x.x() + s * x.y();
  const double y_turned = c * x.y() - s * x.x();
  angles.last = std::atan2(angles.cos_middle * y_turned + angles.sin_middle * x.z(), x_turned);
  return angles;
}

// The longest way from the first joint to the tip. Free prismatic joints cannot occur: only turning ones are
// continuous.
double reach_of(const Chain& chain) CELL_RT {
  double reach = chain.X_LT().translation().norm();
  bool first = true;
  for (const ChainJoint& joint : chain.joints()) {
    if (!first) reach += joint.X_PJ.translation().norm();
    first = false;
    if (joint.kind != JointKind::prismatic) continue;
    const double lower = std::abs(joint.multiplier * chain.lower()[joint.variable] + joint.offset);
    const double upper = std::abs(joint.multiplier * chain.upper()[joint.variable] + joint.offset);
    reach += std::max(lower, upper);
  }
  return reach;
}

}  // namespace

PackedChain::PackedChain(const Chain& chain) CELL_RT {
  joints = static_cast<int>(chain.joints().size());
  variables = static_cast<int>(chain.variable_count());
  plain = chain.plain();
  reach = reach_of(chain);
  constexpr double kShortest = 1e-3;  // m: a chain that only turns
  constexpr double kShare = 0.5;      // of the reach; measured, and flat around this value
  length = reach > kShortest ? kShare * reach : 1.0;
  for (std::size_t i = 0; i < chain.joints().size(); ++i) {
    const ChainJoint& from = chain.joints()[i];
    const bool last = i + 1 == chain.joints().size();
    const Pose& X_next = last ? chain.X_LT() : chain.joints()[i + 1].X_PJ;
    const EulerZxz own = euler_zxz(from.X_PJ.linear());
    const EulerZxz next = last ? EulerZxz{} : euler_zxz(X_next.linear());
    PackedJoint& to = joint[i];
    to.variable = from.variable;
    to.prismatic = from.kind == JointKind::prismatic;
    to.multiplier = from.multiplier;
    to.offset = own.last + next.first + (to.prismatic ? 0.0 : from.offset);
    to.slide = to.prismatic ? from.offset / length : 0.0;
    const double c = std::cos(next.first);
    const double s = std::sin(next.first);
    const Eigen::Vector3d t = X_next.translation() / length;
    to.t = {c * t.x() + s * t.y(), c * t.y() - s * t.x(), t.z()};
    to.cos_x = next.cos_middle;
    to.sin_x = next.sin_middle;
    if (i > 0) continue;
    const Eigen::Matrix3d R0 =
        from.X_PJ.linear() * Eigen::AngleAxisd(-own.last, Eigen::Vector3d::UnitZ()).toRotationMatrix();
    Eigen::Map<Eigen::Matrix3d>(start_R.data()) = R0;
    Eigen::Map<Eigen::Vector3d>(start_p.data()) = from.X_PJ.translation() / length;
  }
  Eigen::Map<Eigen::Matrix3d>(tool_R.data()) = chain.X_LT().linear();
  for (std::size_t i = 0; i < chain.variable_count(); ++i) {
    scale[i] = chain.rotates(i) ? 1.0 : 1.0 / length;
    lower[i] = chain.lower()[i] * scale[i];
    upper[i] = chain.upper()[i] * scale[i];
  }
}

PackedGoal::PackedGoal(const PackedChain& chain, const Task& task, const Pose& X_BG) CELL_RT
    : orientation(task.orientation) {
  const Eigen::Map<const Eigen::Matrix3d> tool_R(chain.tool_R.data());
  for (std::size_t i = 0; i < 3; ++i) {
    p[i] = X_BG.translation()[static_cast<Eigen::Index>(i)] / chain.length;
    row[i] = (task.position_axes >> i & 1) != 0 ? 1.0 : 0.0;
  }
  if (orientation == OrientationTask::free) return;
  if (orientation == OrientationTask::full) {
    Eigen::Map<Eigen::Matrix3d>(R.data()) = X_BG.linear() * tool_R.transpose();
    return;
  }
  const Eigen::Index axis = orientation == OrientationTask::normal    ? 0
                            : orientation == OrientationTask::sliding ? 1
                                                                      : 2;
  Eigen::Map<Eigen::Vector3d>(tool.data()) = tool_R.col(axis);
  Eigen::Map<Eigen::Vector3d>(aim.data()) = X_BG.linear().col(axis);
}

}  // namespace cellmirror::kinematics
