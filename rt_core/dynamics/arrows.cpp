#include "rt_core/dynamics/arrows.hpp"

#include <utility>

namespace cellmirror::dynamics {

namespace {

using Eigen::Vector3d;

// In the frame in which `value` is given.
Vector3d chosen_part(ArrowComponent component, const Vector3d& value) {
  switch (component) {
    case ArrowComponent::none:
      break;
    case ArrowComponent::x:
      return {value.x(), 0, 0};
    case ArrowComponent::y:
      return {0, value.y(), 0};
    case ArrowComponent::z:
      return {0, 0, value.z()};
    case ArrowComponent::resultant:
      return value;
  }
  return Vector3d::Zero();
}

class Arrows {
 public:
  void add(const Pose& X_WF, const Vector3d& value_F, bool torque) {
    if (!value_F.allFinite() || value_F.norm() < kShortestArrow) return;
    arrows_.push_back({X_WF.translation(), X_WF.linear() * value_F, torque});
  }
  std::vector<ForceArrow> take() { return std::move(arrows_); }

 private:
  std::vector<ForceArrow> arrows_;
};

void add_joint(const ForceArrowSettings& settings, const JointForce& joint, Arrows& arrows) {
  if (settings.motors_only) {
    const bool slides = joint.kind == JointKind::prismatic;
    const ArrowComponent chosen = slides ? settings.joint_forces : settings.joint_torques;
    const Vector3d& value = slides ? joint.wrench_J.force : joint.wrench_J.torque;
    if (chosen != ArrowComponent::none) arrows.add(joint.X_WJ, joint.axis_J.dot(value) * joint.axis_J, !slides);
    return;
  }
  arrows.add(joint.X_WJ, chosen_part(settings.joint_forces, joint.wrench_J.force), false);
  arrows.add(joint.X_WJ, chosen_part(settings.joint_torques, joint.wrench_J.torque), true);
}

}  // namespace

std::vector<ForceArrow> force_arrows(const ForceArrowSettings& settings, const ForceState& forces) {
  Arrows arrows;
  for (const RobotForces& robot : forces.robots) {
    for (const JointForce& joint : robot.joints) add_joint(settings, joint, arrows);
    if (robot.tcp_known) arrows.add(robot.X_WT, chosen_part(settings.tcp_force, robot.tcp_T.force), false);
  }
  return arrows.take();
}

}  // namespace cellmirror::dynamics
