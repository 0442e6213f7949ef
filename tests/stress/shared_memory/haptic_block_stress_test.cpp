// Both sides of the block at full speed. Every number of a sample and of an output is derived from its sequence: a
// mixture of two writes would show.
#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <thread>

#include "ipc/wire/haptic_block.hpp"
#include "ipc/wire/shared_words.hpp"
#include "ipc/wire/tcp_force_block.hpp"

namespace cellmirror {
namespace {

constexpr std::uint64_t kWrites = 100'000;

struct alignas(64) Block {
  std::array<std::byte, haptic_block_offset::kSize> bytes{};
  [[nodiscard]] std::span<std::byte> memory() { return bytes; }
};

HapticSample sample_of(std::uint64_t sequence) {
  const auto value = static_cast<double>(sequence);
  HapticSample sample;
  sample.sequence = sequence;
  sample.time.ns = static_cast<std::int64_t>(sequence);
  sample.writer = sample.buttons = static_cast<std::uint32_t>(sequence);
  sample.axis_count = 7;
  sample.p_DH.setConstant(value);
  sample.q_DH.coeffs().setConstant(value);
  sample.gripper = value;
  sample.axes.fill(value);
  return sample;
}

bool is_whole(const HapticSample& sample) {
  const HapticSample wanted = sample_of(sample.sequence);
  return sample.time == wanted.time && sample.writer == wanted.writer && sample.buttons == wanted.buttons &&
         sample.p_DH == wanted.p_DH && sample.q_DH.coeffs() == wanted.q_DH.coeffs() &&
         sample.gripper == wanted.gripper && sample.axes == wanted.axes;
}

HapticOutput output_of(std::uint64_t sequence) {
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

bool is_whole(const HapticOutput& output) {
  if (output.sequence == 0) return true;  // before the first
  const HapticOutput wanted = output_of(output.sequence);
  return output.answers == wanted.answers && output.time == wanted.time && output.period == wanted.period &&
         output.phase == wanted.phase && output.fault == wanted.fault && output.force_E == wanted.force_E &&
         output.force_D == wanted.force_D && output.torque_D == wanted.torque_D &&
         output.gripper_torque == wanted.gripper_torque && output.max_force == wanted.max_force &&
         output.joint_torques == wanted.joint_torques;
}

TEST(HapticBlockStress, SamplesAreOfOneWrite) {
  Block block;
  std::atomic<bool> over{false};
  std::thread device([&] {
    for (std::uint64_t i = 1; i <= kWrites; ++i) write_haptic_sample(block.memory(), sample_of(i));
    over = true;
  });
  std::uint64_t last = 0;
  std::uint64_t newest = 0;
  std::uint64_t wrong = 0;
  HapticSample sample;
  for (bool ended = false; !ended;) {
    ended = over.load();
    if (read_haptic_sample(block.memory(), last, sample) != HapticRead::fresh) continue;
    if (!is_whole(sample) || sample.sequence <= newest) ++wrong;
    newest = sample.sequence;
  }
  device.join();
  EXPECT_EQ(wrong, 0u);
  EXPECT_EQ(newest, kWrites) << "the last one is there after its writer has ended";
}

TEST(HapticBlockStress, OutputsAreOfOneWrite) {
  Block block;
  prepare_haptic_block(block.memory(), 16, 1);
  std::atomic<bool> over{false};
  std::thread gateway([&] {
    for (std::uint64_t i = 1; i <= kWrites; ++i) {
      restore_haptic_header(block.memory(), 16, 1);
      write_haptic_output(block.memory(), output_of(i));
    }
    over = true;
  });
  std::uint64_t newest = 0;
  std::uint64_t wrong = 0;
  HapticOutput output;
  for (bool ended = false; !ended;) {
    ended = over.load();
    if (!read_haptic_output(block.memory(), output)) continue;
    if (!is_whole(output) || output.sequence < newest) ++wrong;
    newest = output.sequence;
  }
  gateway.join();
  EXPECT_EQ(wrong, 0u);
  EXPECT_EQ(newest, kWrites);
}

TEST(TcpForceBlockStress, BlocksAreOfOneWrite) {
  Block block;
  std::atomic<bool> over{false};
  std::thread gateway([&] {
    for (std::uint64_t i = 1; i <= kWrites; ++i) {
      TcpForce force;
      force.values.fill(static_cast<float>(i % 4096));
      force.sequence = i;
      force.flags = force.process = static_cast<std::uint32_t>(i);
      force.robot = i % 2 == 0 ? std::string_view("EVEN_ROBOT") : std::string_view("ODD");
      write_tcp_force(block.memory(), force);
    }
    over = true;
  });
  std::uint64_t wrong = 0;
  TcpForce force;
  for (bool ended = false; !ended;) {
    ended = over.load();
    if (!read_tcp_force(block.memory(), force)) continue;
    const std::uint64_t i = force.sequence;
    const bool whole = force.values[0] == static_cast<float>(i % 4096) && force.values[3] == force.values[0] &&
                       force.flags == static_cast<std::uint32_t>(i) && force.process == force.flags &&
                       force.robot.view() == (i % 2 == 0 ? "EVEN_ROBOT" : "ODD");
    if (!whole) ++wrong;
  }
  gateway.join();
  EXPECT_EQ(wrong, 0u);
  EXPECT_EQ(force.sequence, kWrites);
}

// A peer that writes anything anywhere: the reader ends, and what it gives is a plain value.
TEST(HapticBlockStress, APeerThatScribblesOverEverythingHarmsNobody) {
  Block block;
  std::atomic<bool> over{false};
  std::thread peer([&] {
    std::uint64_t random = 88172645463325252u;
    while (!over.load(std::memory_order_relaxed)) {
      random ^= random << 13;
      random ^= random >> 7;
      random ^= random << 17;
      const std::size_t words = haptic_block_offset::kSize / 8 - haptic_block_offset::kMagic / 8;
      shared_words::store(block.memory(), haptic_block_offset::kMagic + 8 * (random % words), random);
    }
  });
  std::uint64_t last = 0;
  HapticSample sample;
  HapticOutput output;
  for (std::uint64_t i = 1; i <= kWrites / 10; ++i) {
    restore_haptic_header(block.memory(), 16, 1);
    write_haptic_output(block.memory(), output_of(i));
    static_cast<void>(read_haptic_sample(block.memory(), last, sample));
    ASSERT_LE(sample.axis_count, kMaxHapticAxes);
    static_cast<void>(read_haptic_output(block.memory(), output));
    ASSERT_LE(output.joint_count, kMaxJointsPerRobot);
  }
  over = true;
  peer.join();
}

}  // namespace
}  // namespace cellmirror
