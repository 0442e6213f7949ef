// From what a device says to where it wants the instrument: the drive, the scale, the clutch's anchor.
#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "rt_core/base/pose.hpp"
#include "rt_core/base/real_time.hpp"
#include "rt_core/haptics/instrument.hpp"
#include "rt_core/ports/haptic_device.hpp"

namespace cellmirror::haptics {

// Commanded motion of the hand.
struct TipTarget {
  Eigen::Vector3d x_WE = Eigen::Vector3d::Zero();      // m: the tip's origin
  Eigen::Matrix3d R_WE = Eigen::Matrix3d::Identity();  // drive pose: followed in what freedom the tip's place leaves
  JointValues q{};                                     // drive joints: what the axes say, within the limits
  Eigen::Vector3d p_handle = Eigen::Vector3d::Zero();  // m, world axes: where the handle is, as the device moves
};

// Position of the instrument: all joints, and the tip's pose in the world.
struct Posture {
  JointValues q{};
  Pose X_WE = Pose::Identity();
};

class InstrumentMap {
 public:
  // Back to the anchor of the cell file.
  void restart() CELL_RT { *this = InstrumentMap{}; }

  // `q`: joint positions; joints without an axis of the device stay.
  [[nodiscard]] TipTarget target(const Instrument& instrument, const HapticSample& sample,
                                 const JointValues& q) const CELL_RT;
  // From now on the sample corresponds to the instrument's present posture.
  void anchor(const Instrument& instrument, const HapticSample& sample, const Posture& posture) CELL_RT;
  // The same for the orientation alone; the place stays that of the cell file.
  void anchor_orientation(const Instrument& instrument, const HapticSample& sample, const Posture& posture) CELL_RT;

  // All that the next ticks depend on, for a recording of the tick (rt_core/base/state_bytes.hpp).
  template <class Archive>
  void transfer(Archive& archive) CELL_RT {
    archive(offset_W_, R_HE_, joint_offset_);
  }

 private:
  Eigen::Vector3d offset_W_ = Eigen::Vector3d::Zero();  // m
  Eigen::Matrix3d R_HE_ = Eigen::Matrix3d::Identity();  // orientation of the tool in the hand
  JointValues joint_offset_{};
};

// The joint that the gripper drives, within its limits.
[[nodiscard]] double gripper_value(const Instrument& instrument, const HapticSample& sample) CELL_RT;
// The chain's variable that a joint of the robot is; -1: none.
[[nodiscard]] int variable_of(const Instrument& instrument, int joint) CELL_RT;
// The chain's variables out of all joints of the robot.
[[nodiscard]] JointValues chain_values(const Instrument& instrument, const JointValues& q) CELL_RT;
[[nodiscard]] double within_limits(const Instrument& instrument, std::size_t joint, double value) CELL_RT;

}  // namespace cellmirror::haptics
