#include "drivers/dds/robot_state_messages.hpp"

#include <cmath>

namespace cellmirror::dds {

void JointNames::see(std::span<const RobotState> robots) {
  for (const RobotState& robot : robots) {
    for (const RobotJointState& joint : robot.joints) {
      const auto [owner, is_new] = owner_.try_emplace(joint.name, robot.id);
      if (!is_new && owner->second != robot.id) shared_.insert(joint.name);
    }
  }
}

std::string JointNames::name(const std::string& robot, const std::string& joint) const {
  return shared_.contains(joint) ? robot + '/' + joint : joint;
}

std::size_t fill_joint_state(RosTime stamp, std::span<const RobotState> robots, const JointNames& names,
                             JointState& message) {
  std::size_t left_out = 0;
  message.header.stamp = stamp;
  message.header.frame_id.clear();
  message.name.clear();
  message.position.clear();
  message.velocity.clear();
  message.effort.clear();
  for (const RobotState& robot : robots) {
    for (const RobotJointState& joint : robot.joints) {
      if (!std::isfinite(joint.position) || !std::isfinite(joint.velocity) || !std::isfinite(joint.effort)) {
        ++left_out;
        continue;
      }
      message.name.push_back(names.name(robot.id, joint.name));
      message.position.push_back(joint.position);
      message.velocity.push_back(joint.velocity);
      message.effort.push_back(joint.effort);
    }
  }
  return left_out;
}

std::size_t fill_transforms(RosTime stamp, std::span<const FramePose> frames, TfMessage& message) {
  std::size_t used = 0;
  message.transforms.resize(frames.size());
  for (const FramePose& frame : frames) {
    const Eigen::Quaterniond q = Eigen::Quaterniond(frame.X_PC.linear()).normalized();
    const Eigen::Vector3d p_PC_P = frame.X_PC.translation();
    if (!p_PC_P.allFinite() || !q.coeffs().allFinite()) continue;
    TransformStamped& transform = message.transforms[used++];
    transform.header.stamp = stamp;
    transform.header.frame_id = frame.parent;
    transform.child_frame_id = frame.child;
    transform.translation = {p_PC_P.x(), p_PC_P.y(), p_PC_P.z()};
    transform.rotation = {q.x(), q.y(), q.z(), q.w()};
  }
  message.transforms.resize(used);
  return frames.size() - used;
}

}  // namespace cellmirror::dds
