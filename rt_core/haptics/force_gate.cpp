#include "rt_core/haptics/force_gate.hpp"

#include <algorithm>
#include <cmath>

namespace cellmirror::haptics {

namespace {

// What rounding may add to a force that limit() has brought to its limit and that was turned into the device's axes.
constexpr double kShare = 1e-6;
constexpr double kSlack = 1e-9;  // N

bool finite(const HapticOutput& output) CELL_RT {
  return output.force_D.allFinite() && output.force_E.allFinite() && output.torque_D.allFinite() &&
         std::isfinite(output.gripper_torque) &&
         std::ranges::all_of(output.joint_torques, [](double torque) { return std::isfinite(torque); });
}

bool within(double size, double limit) CELL_RT { return size <= limit * (1 + kShare) + kSlack; }

}  // namespace

void ForceGate::open(HapticDevicePort& port) CELL_RT {
  *this = ForceGate();
  port_ = &port;
}

Eigen::Vector3d ForceGate::limit(const Eigen::Vector3d& force, const ForceLimits& limits, double period) CELL_RT {
  cut_ = false;
  Eigen::Vector3d allowed = force.allFinite() ? force : Eigen::Vector3d::Zero();
  const double size = allowed.norm();
  if (size > limits.largest) {
    allowed *= limits.largest / size;
    cut_ = true;
  }
  const Eigen::Vector3d change = allowed - limited_;
  const double step = change.norm();
  if (step > limits.largest_rate * period) {
    allowed = limited_ + change * (limits.largest_rate * period / step);
    cut_ = true;
  }
  limited_ = allowed;
  return allowed;
}

bool ForceGate::admits(const HapticOutput& output, const ForceLimits& limits, double period) const CELL_RT {
  if (!finite(output)) return false;
  const double force = output.force_D.norm();
  const double step = limits.largest_rate * period;
  return within(force, limits.largest) && (within(force, step) || within((output.force_D - written_).norm(), step));
}

bool ForceGate::write(const HapticOutput& output, const ForceLimits& limits, double period) CELL_RT {
  if (admits(output, limits, period)) {
    written_ = output.force_D;
    port_->write(output);
    return true;
  }
  HapticOutput released = output;
  released.force_D.setZero();
  released.force_E.setZero();
  released.torque_D.setZero();
  released.gripper_torque = 0;
  released.joint_torques = JointValues{};
  restart();
  written_.setZero();
  port_->write(released);
  return false;
}

}  // namespace cellmirror::haptics
