// Samples and outputs of which every number is derived from the sequence: a mixture of two writes shows.
#pragma once

#include <unistd.h>

#include "rt_core/ports/haptic_device.hpp"

namespace cellmirror::test {

inline HapticSample derived_sample(std::uint64_t sequence) {
  const auto value = static_cast<double>(sequence);
  HapticSample sample;
  sample.sequence = sequence;
  sample.time.ns = static_cast<std::int64_t>(sequence);
  sample.writer = static_cast<std::uint32_t>(::getpid());
  sample.valid = true;
  sample.buttons = static_cast<std::uint32_t>(sequence);
  sample.axis_count = 7;
  sample.p_DH.setConstant(value);
  sample.q_DH.coeffs().setConstant(value);
  sample.gripper = value;
  sample.axes.fill(value);
  return sample;
}

// Whoever wrote it.
inline bool is_derived(const HapticSample& sample) {
  const HapticSample wanted = derived_sample(sample.sequence);
  return sample.time == wanted.time && sample.buttons == wanted.buttons && sample.p_DH == wanted.p_DH &&
         sample.q_DH.coeffs() == wanted.q_DH.coeffs() && sample.gripper == wanted.gripper && sample.axes == wanted.axes;
}

inline HapticOutput derived_output(std::uint64_t sequence) {
  const auto value = static_cast<double>(sequence % 4096);  // exact as float32
  HapticOutput output;
  output.sequence = output.answers = sequence;
  output.time.ns = static_cast<std::int64_t>(sequence);
  output.period = Nanoseconds(static_cast<std::int64_t>(sequence));
  output.phase = output.fault = static_cast<std::uint32_t>(sequence);
  output.force_E.setConstant(value);
  output.force_D.setConstant(value);
  output.torque_D.setConstant(value);
  output.gripper_torque = output.max_force = value;
  output.joint_count = 16;
  output.joint_torques.fill(value);
  return output;
}

}  // namespace cellmirror::test
