// The coordinates of a simulated haptic device, and how they become a sample and are pushed by an answer.
//
//   4 axes: yaw, pitch, insertion, roll     a laparoscopic handle on a trocar; 5: and the jaw
//   6 axes: x, y, z, rx, ry, rz             a handle in space; r: rotation vector; 7: and the gripper
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <string_view>

#include "rt_core/ports/haptic_device.hpp"

namespace cellmirror::sim {

using Coordinates = std::array<double, kMaxHapticAxes>;  // m or rad; those behind the device's axes are 0

enum class AxisKind { length, angle, gripper };

class AxisLayout {
 public:
  // 4 to 7.
  explicit AxisLayout(std::size_t axes);

  [[nodiscard]] std::size_t count() const { return count_; }
  [[nodiscard]] bool is_trocar() const { return count_ <= 5; }
  [[nodiscard]] std::span<const std::string_view> names() const;
  [[nodiscard]] AxisKind kind(std::size_t axis) const;
  [[nodiscard]] std::optional<std::size_t> find(std::string_view name) const;

  // Handle, gripper and axes of `sample`; the rest is left as it is.
  void show(const Coordinates& coordinates, HapticSample& sample) const;
  // What the answer pushes each coordinate with, N or Nm: of a trocar the torques of the instrument's joints, in their
  // order, else force and torque at the handle.
  [[nodiscard]] Coordinates efforts(const HapticOutput& output) const;

 private:
  std::size_t count_;
};

}  // namespace cellmirror::sim
