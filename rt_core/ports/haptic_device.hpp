// Interface of a haptic device for the tick: a pose and buttons in, a force out.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <cstdint>

#include "rt_core/base/object_id.hpp"
#include "rt_core/base/real_time.hpp"
#include "rt_core/base/time.hpp"
#include "rt_core/ports/robot_parameters.hpp"

namespace cellmirror {

inline constexpr std::size_t kMaxHapticDevices = 4;
inline constexpr std::size_t kMaxHapticAxes = 7;

// A sample of a device at one instant, in its own base frame D; the cell file gives the pose of D in the world. SI.
struct HapticSample {
  std::uint64_t sequence = 0;  // counted by the device's process, from 1
  std::uint64_t writes = 0;    // number of writes by any process; 0: unknown
  Timestamp time;              // of the measurement, CLOCK_MONOTONIC of this machine
  std::uint32_t writer = 0;    // process id of the device's process
  bool valid = false;          // the device itself says that its values are good
  std::uint32_t buttons = 0;   // bit 0: the first
  std::uint8_t axis_count = 0;
  Eigen::Vector3d p_DH = Eigen::Vector3d::Zero();            // of the handle, m
  Eigen::Quaterniond q_DH = Eigen::Quaterniond::Identity();  // as it came: perhaps not of unit length
  double gripper = 0;                                        // rad, 0: closed
  std::array<double, kMaxHapticAxes> axes{};                 // rad or m; the first axis_count count
};

// What the gateway answers.
struct HapticOutput {
  std::uint64_t sequence = 0;  // counted by the gateway
  Timestamp time;              // of the tick
  Nanoseconds period{};
  std::uint64_t answers = 0;                           // sequence of the sample that it was computed from
  std::uint32_t phase = 0;                             // HapticPhase
  std::uint32_t fault = 0;                             // HapticFault
  Eigen::Vector3d force_E = Eigen::Vector3d::Zero();   // N, on the hand, in the instrument's end-effector frame
  Eigen::Vector3d force_D = Eigen::Vector3d::Zero();   // N, on the hand, in the device's base frame, scaled for it
  Eigen::Vector3d torque_D = Eigen::Vector3d::Zero();  // Nm, likewise
  double gripper_torque = 0;                           // Nm, positive opens
  std::uint8_t joint_count = 0;
  JointValues joint_torques{};  // Nm or N, of the instrument's joints
  double max_force = 0;         // N, to which force_D is limited
};

enum class HapticRead : std::uint8_t {
  fresh,      // `sample` holds another one than at the last call
  unchanged,  // nothing was written since
  torn,       // the device was writing all the time: nothing could be read
  none,       // no device ever wrote, or the memory is too small for samples
};

// Owned off the tick; read() and write() belong to the tick. Bounded time, no system call.
class HapticDevicePort {
 public:
  virtual ~HapticDevicePort() = default;
  virtual HapticRead read(HapticSample& sample) CELL_RT = 0;
  virtual void write(const HapticOutput& output) CELL_RT = 0;
  // How recordings name it.
  [[nodiscard]] std::uint64_t reference_id() const CELL_RT { return id_.value(); }

 private:
  ObjectId id_;
};

}  // namespace cellmirror
