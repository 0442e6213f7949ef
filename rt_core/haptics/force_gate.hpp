// The only way of forces to a haptic device: it holds the device's port, and nothing else writes to it.
#pragma once

#include <Eigen/Core>

#include "rt_core/base/real_time.hpp"
#include "rt_core/ports/haptic_device.hpp"

namespace cellmirror::haptics {

// Of the force at the device.
struct ForceLimits {
  double largest = 0;       // N
  double largest_rate = 0;  // N/s; a force that is released, or that starts again from zero, is not slowed
};

// Tick thread only.
class ForceGate {
 public:
  // `port` outlives the time until close().
  void open(HapticDevicePort& port) CELL_RT;
  void close() CELL_RT { port_ = nullptr; }
  [[nodiscard]] HapticRead read(HapticSample& sample) CELL_RT { return port_->read(sample); }

  // The force starts again from zero.
  void restart() CELL_RT { limited_.setZero(); }
  // Keeps a force [N] within its limits. What it gives is what the hand gets until the next tick, `period` s later. A
  // force that is no number becomes zero.
  Eigen::Vector3d limit(const Eigen::Vector3d& force, const ForceLimits& limits, double period) CELL_RT;
  [[nodiscard]] bool cut() const CELL_RT { return cut_; }  // by the last limit()

  // Whether write() passes the forces on: all values finite, force_D within the limits.
  [[nodiscard]] bool admits(const HapticOutput& output, const ForceLimits& limits, double period) const CELL_RT;
  // What is not admitted reaches the device with zero forces and torques. False then.
  bool write(const HapticOutput& output, const ForceLimits& limits, double period) CELL_RT;

  // All that the next ticks depend on but the port, for a recording of the tick (rt_core/base/state_bytes.hpp).
  template <class Archive>
  void transfer(Archive& archive) CELL_RT {
    archive(limited_, written_, cut_);
  }

 private:
  HapticDevicePort* port_ = nullptr;
  Eigen::Vector3d limited_ = Eigen::Vector3d::Zero();  // N, by the last limit()
  Eigen::Vector3d written_ = Eigen::Vector3d::Zero();  // N, force_D that the device has
  bool cut_ = false;
};

}  // namespace cellmirror::haptics
