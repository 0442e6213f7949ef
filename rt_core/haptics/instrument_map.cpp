#include "rt_core/haptics/instrument_map.hpp"

#include <algorithm>

#include "rt_core/kinematics/forward.hpp"

namespace cellmirror::haptics {

namespace {

// The axes in their order are the joints in theirs; the joint of the gripper has no axis.
std::size_t joint_of_axis(const Instrument& instrument, std::size_t axis) CELL_RT {
  const int gripper = instrument.settings.gripper_joint;
  return gripper >= 0 && axis >= static_cast<std::size_t>(gripper) ? axis + 1 : axis;
}

Eigen::Matrix3d handle_orientation(const Instrument& instrument, const HapticSample& sample) CELL_RT {
  return instrument.settings.X_WD.linear() * sample.q_DH.normalized().toRotationMatrix();
}

}  // namespace

double within_limits(const Instrument& instrument, std::size_t joint, double value) CELL_RT {
  return std::min(std::max(value, instrument.lower[joint]), instrument.upper[joint]);
}

double gripper_value(const Instrument& instrument, const HapticSample& sample) CELL_RT {
  const HapticSettings& settings = instrument.settings;
  return within_limits(instrument, static_cast<std::size_t>(settings.gripper_joint),
                       settings.gripper_scale * sample.gripper + settings.gripper_offset);
}

int variable_of(const Instrument& instrument, int joint) CELL_RT {
  for (std::size_t i = 0; i < instrument.chain.variable_count(); ++i) {
    if (instrument.variable_joint[i] == joint) return static_cast<int>(i);
  }
  return -1;
}

JointValues chain_values(const Instrument& instrument, const JointValues& q) CELL_RT {
  JointValues values{};
  for (std::size_t i = 0; i < instrument.chain.variable_count(); ++i) {
    values[i] = q[instrument.variable_joint[i]];
  }
  return values;
}

TipTarget InstrumentMap::target(const Instrument& instrument, const HapticSample& sample,
                                const JointValues& q) const CELL_RT {
  const HapticSettings& settings = instrument.settings;
  TipTarget target;
  if (settings.drive == Drive::pose) {
    target.p_handle = settings.X_WD.linear() * sample.p_DH;
    target.x_WE = settings.X_WD.translation() + offset_W_ + settings.workspace_scale * target.p_handle;
    target.R_WE = handle_orientation(instrument, sample) * R_HE_;
    return target;
  }
  target.q = q;
  for (std::size_t axis = 0; axis < sample.axis_count; ++axis) {
    const std::size_t joint = joint_of_axis(instrument, axis);
    if (joint >= instrument.joint_count) break;
    target.q[joint] = within_limits(instrument, joint, sample.axes[axis] + joint_offset_[joint]);
  }
  if (settings.gripper_joint >= 0) {
    target.q[static_cast<std::size_t>(settings.gripper_joint)] = gripper_value(instrument, sample);
  }
  const Pose X_WE = instrument.X_WB * kinematics::forward(instrument.chain, chain_values(instrument, target.q));
  target.x_WE = X_WE.translation();
  target.R_WE = X_WE.linear();
  target.p_handle = target.x_WE;
  return target;
}

void InstrumentMap::anchor_orientation(const Instrument& instrument, const HapticSample& sample,
                                       const Posture& posture) CELL_RT {
  R_HE_ = handle_orientation(instrument, sample).transpose() * posture.X_WE.linear();
}

void InstrumentMap::anchor(const Instrument& instrument, const HapticSample& sample, const Posture& posture) CELL_RT {
  const HapticSettings& settings = instrument.settings;
  if (settings.drive == Drive::pose) {
    anchor_orientation(instrument, sample, posture);
    offset_W_ = posture.X_WE.translation() - settings.X_WD.translation() -
                settings.workspace_scale * (settings.X_WD.linear() * sample.p_DH);
    return;
  }
  for (std::size_t axis = 0; axis < sample.axis_count; ++axis) {
    const std::size_t joint = joint_of_axis(instrument, axis);
    if (joint >= instrument.joint_count) break;
    joint_offset_[joint] = posture.q[joint] - sample.axes[axis];
  }
}

}  // namespace cellmirror::haptics
