#include "rt_core/kinematics/forward_constants.hpp"

#include <cmath>

#include "rt_core/kinematics/chain.hpp"

namespace cellmirror::kinematics {

namespace {

// R = Rz(first) Rx(middle) Rz(last).
struct EulerZxz {
  double first = 0;
  double cos_middle = 1;
  double sin_middle = 0;
  double last = 0;
};

EulerZxz euler_zxz(const Eigen::Matrix3d& R) {
  EulerZxz angles;
  const double across = std::hypot(R(0, 2), R(1, 2));
  const double norm = std::hypot(across, R(2, 2));
  angles.sin_middle = across / norm;
  angles.cos_middle = R(2, 2) / norm;
  if (across > 0) angles.first = std::atan2(R(0, 2), -R(1, 2));
  // The last turn is what is left, so that a middle angle near 0 or pi costs no accuracy.
  const double c = std::cos(angles.first);
  const double s = std::sin(angles.first);
  const double along = c * R(0, 0) + s * R(1, 0);
  const double aside = c * R(1, 0) - s * R(0, 0);
  angles.last = std::atan2(angles.cos_middle * aside + angles.sin_middle * R(2, 0), along);
  return angles;
}

Eigen::Matrix3d turn_about_z(double angle) {
  return Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitZ()).toRotationMatrix();
}

const ForwardKernels& kernels() {
#ifdef CELLMIRROR_AVX2_KERNELS
  static const ForwardKernels chosen = __builtin_cpu_supports("avx2") != 0 && __builtin_cpu_supports("fma") != 0
                                           ? avx2::forward_kernels()
                                           : baseline::forward_kernels();
#else
  static const ForwardKernels chosen = baseline::forward_kernels();
#endif
  return chosen;
}

}  // namespace

ForwardConstants forward_constants(const ChainJoint* joints, std::size_t count, std::size_t variables, bool plain,
                                   const double* X_LT) {
  const Pose tip{Eigen::Matrix4d{Eigen::Map<const Eigen::Matrix4d>(X_LT)}};
  ForwardConstants out;
  out.joints = count;
  out.variables = variables;
  out.plain = plain;
  EulerZxz before = euler_zxz(joints[0].X_PJ.linear());
  Pose X_B0 = joints[0].X_PJ;
  X_B0.linear() = X_B0.linear() * turn_about_z(-before.last);
  Eigen::Map<Eigen::Matrix4d>(out.X_B0) = X_B0.matrix();
  for (std::size_t i = 0; i < count; ++i) {
    const ChainJoint& from = joints[i];
    const Pose& X_JN = i + 1 == count ? tip : joints[i + 1].X_PJ;
    const EulerZxz after = euler_zxz(X_JN.linear());
    ForwardConstants::Joint& to = out.joint[i];
    to.variable = from.variable;
    to.factor = from.multiplier;
    to.prismatic = from.kind == JointKind::prismatic;
    to.slide = to.prismatic ? from.multiplier : 0.0;
    to.cos_x = after.cos_middle;
    to.sin_x = after.sin_middle;
    Eigen::Map<Eigen::Vector3d> shift(to.shift);
    shift = turn_about_z(-after.first) * X_JN.translation();
    if (to.prismatic) shift.z() += from.offset;
    out.turn[i] = to.prismatic ? 0.0 : from.multiplier;
    out.turn_zero[i] = before.last + after.first + (to.prismatic ? 0.0 : from.offset);
    before = after;
  }
  out.tip_cos = std::cos(before.last);
  out.tip_sin = std::sin(before.last);
  const std::size_t size = count < ForwardKernels::kSizes ? count : 0;
  out.pose = kernels().pose[size];
  out.pose_and_jacobian = kernels().pose_and_jacobian[size];
  return out;
}

}  // namespace cellmirror::kinematics
