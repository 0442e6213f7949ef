#include "ipc/wire/haptic_block.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include "ipc/wire/shared_words.hpp"
#include "rt_core/ports/haptic_state.hpp"

namespace cellmirror {
namespace {

namespace at = haptic_block_offset;
using shared_words::first_of;
using shared_words::pair;
using shared_words::second_of;

constexpr std::uint32_t kGoodFlag = 1;
constexpr std::size_t kForceWords = (at::kMaxForce + 8 - at::kForceSequence) / 8;
constexpr std::size_t kSampleWords = (at::kAxes + 8 * kMaxHapticAxes - at::kDeviceSequence) / 8;
constexpr std::size_t kFloats = 3 + kMaxJointsPerRobot;
static_assert(at::kAxes + 8 * kMaxHapticAxes <= at::kSize && at::kJointTorque + 4 * kMaxJointsPerRobot <= at::kMagic);

bool holds_all(std::span<const std::byte> memory) CELL_RT {
  return memory.size() >= at::kSize && shared_words::is_aligned(memory);
}

std::uint16_t bounded_joints(std::uint8_t joint_count) CELL_RT {
  return static_cast<std::uint16_t>(std::min<std::size_t>(joint_count, kMaxJointsPerRobot));
}

std::uint64_t name_word(std::uint8_t joint_count) CELL_RT {
  return pair(kHapticBlockMagic, kHapticBlockVersion | static_cast<std::uint32_t>(bounded_joints(joint_count)) << 16);
}

std::uint64_t maker_word(std::uint32_t process) CELL_RT { return pair(static_cast<std::uint32_t>(at::kSize), process); }

bool is_our_version(std::uint64_t name) CELL_RT {
  return first_of(name) == kHapticBlockMagic && (second_of(name) & 0xffffu) == kHapticBlockVersion;
}

using Floats = std::array<float, kFloats>;  // read by a program of 1999

bool all_finite(const HapticOutput& output, const Floats& floats) CELL_RT {
  bool good = std::isfinite(output.gripper_torque) && std::isfinite(output.max_force);
  for (const float value : floats) good = good && std::isfinite(value);
  for (int i = 0; i < 3; ++i) good = good && std::isfinite(output.force_D[i]) && std::isfinite(output.torque_D[i]);
  return good;
}

// A double beyond float32 becomes infinite here, which all_finite() then detects.
Floats floats_of(const HapticOutput& output) CELL_RT {
  Floats floats{};
  for (std::size_t i = 0; i < 3; ++i) floats[i] = static_cast<float>(output.force_E[static_cast<int>(i)]);
  for (std::size_t i = 0; i < bounded_joints(output.joint_count); ++i) {
    floats[3 + i] = static_cast<float>(output.joint_torques[i]);
  }
  return floats;
}

void store_floats(std::span<std::byte> memory, const Floats& floats) CELL_RT {
  const std::size_t fit = std::min(memory.size() / 4, floats.size());
  for (std::size_t i = 0; i < fit; ++i) shared_words::store_f32(memory, at::kForce + 4 * i, floats[i]);
}

void store_force(std::span<std::byte> memory, const HapticOutput& output, const Floats& floats) CELL_RT {
  const shared_words::WriteLock lock(memory, at::kForceLock);
  store_floats(memory, floats);
  shared_words::store(memory, at::kForceSequence, output.sequence);
  shared_words::store(memory, at::kForceTime, std::bit_cast<std::uint64_t>(output.time.ns));
  shared_words::store(memory, at::kPeriod, std::bit_cast<std::uint64_t>(std::int64_t{output.period.count()}));
  shared_words::store(memory, at::kAnswers, output.answers);
  shared_words::store(memory, at::kPhase, pair(output.phase, output.fault));
  for (std::size_t i = 0; i < 3; ++i) {
    const auto axis = static_cast<int>(i);
    shared_words::store_f64(memory, at::kForceD + 8 * i, output.force_D[axis]);
    shared_words::store_f64(memory, at::kTorqueD + 8 * i, output.torque_D[axis]);
  }
  shared_words::store_f64(memory, at::kGripperTorque, output.gripper_torque);
  shared_words::store_f64(memory, at::kMaxForce, output.max_force);
}

// The same output without any force.
HapticOutput without_force(const HapticOutput& output) CELL_RT {
  HapticOutput zero;
  zero.sequence = output.sequence;
  zero.time = output.time;
  zero.period = output.period;
  zero.answers = output.answers;
  zero.phase = output.phase;
  zero.fault = output.fault;
  zero.joint_count = output.joint_count;
  zero.max_force = std::isfinite(output.max_force) ? output.max_force : 0;
  return zero;
}

double number(std::uint64_t word) CELL_RT { return std::bit_cast<double>(word); }

// CLOCK_MONOTONIC begins at 0. An earlier value is not a time, and its difference to one might overflow.
Timestamp time_of(std::uint64_t word) CELL_RT {
  return Timestamp{std::max(std::bit_cast<std::int64_t>(word), std::int64_t{0})};
}

}  // namespace

void prepare_haptic_block(std::span<std::byte> memory, std::uint8_t joint_count, std::uint32_t process) CELL_RT {
  HapticOutput nothing;
  nothing.joint_count = joint_count;
  write_haptic_output(memory, nothing);
  if (!holds_all(memory)) return;
  // The name last: it marks a valid block.
  shared_words::store(memory, at::kBytes, maker_word(process));
  shared_words::store(memory, at::kMagic, name_word(joint_count));
}

bool restore_haptic_header(std::span<std::byte> memory, std::uint8_t joint_count, std::uint32_t process) CELL_RT {
  if (!holds_all(memory)) return false;
  const std::uint64_t name = name_word(joint_count);
  const std::uint64_t maker = maker_word(process);
  if (shared_words::load<std::uint64_t>(memory, at::kMagic) == name &&
      shared_words::load<std::uint64_t>(memory, at::kBytes) == maker) {
    return false;
  }
  shared_words::store(memory, at::kBytes, maker);
  shared_words::store(memory, at::kMagic, name);
  return true;
}

void write_haptic_output(std::span<std::byte> memory, const HapticOutput& output) CELL_RT {
  if (!shared_words::is_aligned(memory)) return;
  const Floats floats = floats_of(output);
  if (!all_finite(output, floats)) {
    HapticOutput zero = without_force(output);
    if (zero.fault == 0) zero.fault = static_cast<std::uint32_t>(HapticFault::not_finite);
    write_haptic_output(memory, zero);
    return;
  }
  if (holds_all(memory)) {
    store_force(memory, output, floats);
  } else {
    store_floats(memory, floats);
  }
}

void end_haptic_block(std::span<std::byte> memory) CELL_RT {
  HapticOutput last;
  if (holds_all(memory)) {
    // The numbers continue, so that a reader that compares them detects the new block.
    last.sequence = shared_words::load<std::uint64_t>(memory, at::kForceSequence) + 1;
    last.time.ns = std::bit_cast<std::int64_t>(shared_words::load<std::uint64_t>(memory, at::kForceTime));
  }
  write_haptic_output(memory, last);
  if (holds_all(memory)) shared_words::store(memory, at::kBytes, maker_word(0));
}

HapticRead read_haptic_sample(std::span<const std::byte> memory, std::uint64_t& last, HapticSample& sample) CELL_RT {
  if (!holds_all(memory)) return HapticRead::none;
  const auto now = shared_words::load<std::uint64_t>(memory, at::kDeviceLock);
  if (now == 0) return HapticRead::none;
  if (now == last) return HapticRead::unchanged;
  std::array<std::uint64_t, kSampleWords> words;
  std::uint64_t lock = 0;
  const auto copy = [&]() CELL_RT { shared_words::load_words(memory, at::kDeviceSequence, words); };
  if (!shared_words::read_locked(memory, at::kDeviceLock, lock, copy)) return HapticRead::torn;
  // It may have been set back in the meantime.
  if (lock == 0) return HapticRead::none;
  if (lock == last) return HapticRead::unchanged;
  last = lock;

  const auto word = [&](std::size_t offset) CELL_RT { return words[(offset - at::kDeviceSequence) / 8]; };
  sample.sequence = word(at::kDeviceSequence);
  sample.writes = lock / 2;
  sample.time = time_of(word(at::kDeviceTime));
  sample.writer = first_of(word(at::kDeviceProcess));
  sample.buttons = first_of(word(at::kButtons));
  const std::uint32_t axis_count = second_of(word(at::kButtons));
  const bool axes_known = axis_count <= kMaxHapticAxes;
  sample.valid = axes_known && (second_of(word(at::kDeviceProcess)) & kGoodFlag) != 0;
  sample.axis_count = static_cast<std::uint8_t>(axes_known ? axis_count : 0);
  for (std::size_t i = 0; i < 3; ++i) sample.p_DH[static_cast<int>(i)] = number(word(at::kPosition + 8 * i));
  for (std::size_t i = 0; i < 4; ++i) {
    sample.q_DH.coeffs()[static_cast<int>(i)] = number(word(at::kOrientation + 8 * i));  // x y z w, as Eigen's
  }
  sample.gripper = number(word(at::kGripper));
  for (std::size_t i = 0; i < kMaxHapticAxes; ++i) {
    sample.axes[i] = i < sample.axis_count ? number(word(at::kAxes + 8 * i)) : 0;
  }
  return HapticRead::fresh;
}

void write_haptic_sample(std::span<std::byte> memory, const HapticSample& sample) CELL_RT {
  if (!holds_all(memory)) return;
  const auto axis_count = static_cast<std::uint32_t>(std::min<std::size_t>(sample.axis_count, kMaxHapticAxes));
  const shared_words::WriteLock lock(memory, at::kDeviceLock);
  shared_words::store(memory, at::kDeviceSequence, sample.sequence);
  shared_words::store(memory, at::kDeviceTime, std::bit_cast<std::uint64_t>(sample.time.ns));
  shared_words::store(memory, at::kDeviceProcess, pair(sample.writer, sample.valid ? kGoodFlag : 0));
  shared_words::store(memory, at::kButtons, pair(sample.buttons, axis_count));
  for (std::size_t i = 0; i < 3; ++i) {
    shared_words::store_f64(memory, at::kPosition + 8 * i, sample.p_DH[static_cast<int>(i)]);
  }
  for (std::size_t i = 0; i < 4; ++i) {
    shared_words::store_f64(memory, at::kOrientation + 8 * i, sample.q_DH.coeffs()[static_cast<int>(i)]);
  }
  shared_words::store_f64(memory, at::kGripper, sample.gripper);
  for (std::size_t i = 0; i < kMaxHapticAxes; ++i) {
    shared_words::store_f64(memory, at::kAxes + 8 * i, i < axis_count ? sample.axes[i] : 0);
  }
}

bool read_haptic_output(std::span<const std::byte> memory, HapticOutput& output) CELL_RT {
  if (!holds_all(memory)) return false;
  const auto name = shared_words::load<std::uint64_t>(memory, at::kMagic);
  if (!is_our_version(name)) return false;
  Floats floats{};
  std::array<std::uint64_t, kForceWords> words;
  std::uint64_t lock = 0;
  const auto copy = [&]() CELL_RT {
    for (std::size_t i = 0; i < floats.size(); ++i) {
      floats[i] = std::bit_cast<float>(shared_words::load<std::uint32_t>(memory, at::kForce + 4 * i));
    }
    shared_words::load_words(memory, at::kForceSequence, words);
  };
  if (!shared_words::read_locked(memory, at::kForceLock, lock, copy)) return false;

  const auto word = [&](std::size_t offset) CELL_RT { return words[(offset - at::kForceSequence) / 8]; };
  output.sequence = word(at::kForceSequence);
  output.time = time_of(word(at::kForceTime));
  output.period = Nanoseconds(std::bit_cast<std::int64_t>(word(at::kPeriod)));
  output.answers = word(at::kAnswers);
  output.phase = first_of(word(at::kPhase));
  output.fault = second_of(word(at::kPhase));
  for (std::size_t i = 0; i < 3; ++i) {
    const auto axis = static_cast<int>(i);
    output.force_E[axis] = static_cast<double>(floats[i]);
    output.force_D[axis] = number(word(at::kForceD + 8 * i));
    output.torque_D[axis] = number(word(at::kTorqueD + 8 * i));
  }
  output.gripper_torque = number(word(at::kGripperTorque));
  output.max_force = number(word(at::kMaxForce));
  output.joint_count = static_cast<std::uint8_t>(std::min<std::size_t>(second_of(name) >> 16, kMaxJointsPerRobot));
  for (std::size_t i = 0; i < kMaxJointsPerRobot; ++i) {
    output.joint_torques[i] = i < output.joint_count ? static_cast<double>(floats[3 + i]) : 0;
  }
  return true;
}

std::uint32_t haptic_block_gateway(std::span<const std::byte> memory) CELL_RT {
  if (!holds_all(memory) || !is_our_version(shared_words::load<std::uint64_t>(memory, at::kMagic))) return 0;
  return second_of(shared_words::load<std::uint64_t>(memory, at::kBytes));
}

}  // namespace cellmirror
