// docs/shared-memory.md, docs/examples/cellmirror_haptic.h and the codecs tell the same.
#include <gtest/gtest.h>

#include <array>
#include <cstddef>
#include <cstring>

#include "docs/examples/cellmirror_haptic.h"
#include "ipc/wire/haptic_block.hpp"
#include "ipc/wire/tcp_force_block.hpp"
#include "rt_core/ports/haptic_state.hpp"
#include "tests/unit/ipc/documented_table.hpp"

namespace cellmirror {
namespace {

constexpr const char* kPage = "shared-memory.md";

TEST(DocumentedMemory, OfAHapticDevice) {
  namespace at = haptic_block_offset;
  using Force = cellmirror_haptic_force;
  using Sample = cellmirror_haptic_sample;
  constexpr std::size_t kSample = sizeof(Force);
  test::expect_agreement(
      kPage, "Haptic device",
      {{"force", "f32[3]", at::kForce, offsetof(Force, force), CELLMIRROR_HAPTIC_OFFSET_FORCE},
       {"joint_torque", "f32[16]", at::kJointTorque, offsetof(Force, joint_torque),
        CELLMIRROR_HAPTIC_OFFSET_JOINT_TORQUE},
       {"magic", "u32", at::kMagic, offsetof(Force, magic), CELLMIRROR_HAPTIC_OFFSET_MAGIC},
       {"version", "u16", at::kVersion, offsetof(Force, version), CELLMIRROR_HAPTIC_OFFSET_VERSION},
       {"joint_count", "u16", at::kJointCount, offsetof(Force, joint_count), CELLMIRROR_HAPTIC_OFFSET_JOINT_COUNT},
       {"bytes", "u32", at::kBytes, offsetof(Force, bytes), CELLMIRROR_HAPTIC_OFFSET_BYTES},
       {"gateway", "u32", at::kGateway, offsetof(Force, gateway), CELLMIRROR_HAPTIC_OFFSET_GATEWAY},
       {"force_lock", "u64", at::kForceLock, offsetof(Force, lock), CELLMIRROR_HAPTIC_OFFSET_FORCE_LOCK},
       {"force_sequence", "u64", at::kForceSequence, offsetof(Force, sequence),
        CELLMIRROR_HAPTIC_OFFSET_FORCE_SEQUENCE},
       {"force_time_ns", "i64", at::kForceTime, offsetof(Force, time_ns), CELLMIRROR_HAPTIC_OFFSET_FORCE_TIME_NS},
       {"period_ns", "i64", at::kPeriod, offsetof(Force, period_ns), CELLMIRROR_HAPTIC_OFFSET_PERIOD_NS},
       {"answers", "u64", at::kAnswers, offsetof(Force, answers), CELLMIRROR_HAPTIC_OFFSET_ANSWERS},
       {"phase", "u32", at::kPhase, offsetof(Force, phase), CELLMIRROR_HAPTIC_OFFSET_PHASE},
       {"fault", "u32", at::kFault, offsetof(Force, fault), CELLMIRROR_HAPTIC_OFFSET_FAULT},
       {"force_device", "f64[3]", at::kForceD, offsetof(Force, force_device), CELLMIRROR_HAPTIC_OFFSET_FORCE_DEVICE},
       {"torque_device", "f64[3]", at::kTorqueD, offsetof(Force, torque_device),
        CELLMIRROR_HAPTIC_OFFSET_TORQUE_DEVICE},
       {"gripper_torque", "f64", at::kGripperTorque, offsetof(Force, gripper_torque),
        CELLMIRROR_HAPTIC_OFFSET_GRIPPER_TORQUE},
       {"max_force", "f64", at::kMaxForce, offsetof(Force, max_force), CELLMIRROR_HAPTIC_OFFSET_MAX_FORCE},
       {"device_lock", "u64", at::kDeviceLock, kSample + offsetof(Sample, lock), CELLMIRROR_HAPTIC_OFFSET_DEVICE_LOCK},
       {"device_sequence", "u64", at::kDeviceSequence, kSample + offsetof(Sample, sequence),
        CELLMIRROR_HAPTIC_OFFSET_DEVICE_SEQUENCE},
       {"device_time_ns", "i64", at::kDeviceTime, kSample + offsetof(Sample, time_ns),
        CELLMIRROR_HAPTIC_OFFSET_DEVICE_TIME_NS},
       {"device_process", "u32", at::kDeviceProcess, kSample + offsetof(Sample, process),
        CELLMIRROR_HAPTIC_OFFSET_DEVICE_PROCESS},
       {"device_flags", "u32", at::kDeviceFlags, kSample + offsetof(Sample, flags),
        CELLMIRROR_HAPTIC_OFFSET_DEVICE_FLAGS},
       {"buttons", "u32", at::kButtons, kSample + offsetof(Sample, buttons), CELLMIRROR_HAPTIC_OFFSET_BUTTONS},
       {"axis_count", "u32", at::kAxisCount, kSample + offsetof(Sample, axis_count),
        CELLMIRROR_HAPTIC_OFFSET_AXIS_COUNT},
       {"position", "f64[3]", at::kPosition, kSample + offsetof(Sample, position), CELLMIRROR_HAPTIC_OFFSET_POSITION},
       {"orientation", "f64[4]", at::kOrientation, kSample + offsetof(Sample, orientation),
        CELLMIRROR_HAPTIC_OFFSET_ORIENTATION},
       {"gripper", "f64", at::kGripper, kSample + offsetof(Sample, gripper), CELLMIRROR_HAPTIC_OFFSET_GRIPPER},
       {"axes", "f64[7]", at::kAxes, kSample + offsetof(Sample, axes), CELLMIRROR_HAPTIC_OFFSET_AXES}});
  EXPECT_EQ(sizeof(Force) + sizeof(Sample), at::kSize);
  EXPECT_EQ(std::size_t{CELLMIRROR_HAPTIC_BYTES}, at::kSize);
  EXPECT_EQ(CELLMIRROR_HAPTIC_MAGIC, kHapticBlockMagic);
  EXPECT_EQ(CELLMIRROR_HAPTIC_VERSION, kHapticBlockVersion);
}

TEST(DocumentedMemory, OfTheForceAtTheTcp) {
  namespace at = tcp_force_block_offset;
  using Struct = cellmirror_tcp_force;
  test::expect_agreement(
      kPage, "Force at the TCP",
      {{"values", "f32[4]", at::kValues, offsetof(Struct, values), CELLMIRROR_TCP_FORCE_OFFSET_VALUES},
       {"magic", "u32", at::kMagic, offsetof(Struct, magic), CELLMIRROR_TCP_FORCE_OFFSET_MAGIC},
       {"version", "u16", at::kVersion, offsetof(Struct, version), CELLMIRROR_TCP_FORCE_OFFSET_VERSION},
       {"bytes", "u16", at::kBytes, offsetof(Struct, bytes), CELLMIRROR_TCP_FORCE_OFFSET_BYTES},
       {"lock", "u64", at::kLock, offsetof(Struct, lock), CELLMIRROR_TCP_FORCE_OFFSET_LOCK},
       {"sequence", "u64", at::kSequence, offsetof(Struct, sequence), CELLMIRROR_TCP_FORCE_OFFSET_SEQUENCE},
       {"time_ns", "i64", at::kTime, offsetof(Struct, time_ns), CELLMIRROR_TCP_FORCE_OFFSET_TIME_NS},
       {"flags", "u32", at::kFlags, offsetof(Struct, flags), CELLMIRROR_TCP_FORCE_OFFSET_FLAGS},
       {"process", "u32", at::kProcess, offsetof(Struct, process), CELLMIRROR_TCP_FORCE_OFFSET_PROCESS},
       {"robot", "char[64]", at::kRobot, offsetof(Struct, robot), CELLMIRROR_TCP_FORCE_OFFSET_ROBOT}});
  EXPECT_EQ(sizeof(Struct), at::kSize);
  EXPECT_EQ(CELLMIRROR_TCP_FORCE_KEY, kTcpForceKey);
  EXPECT_EQ(CELLMIRROR_TCP_FORCE_MAGIC, kTcpForceMagic);
  EXPECT_EQ(CELLMIRROR_TCP_FORCE_VERSION, kTcpForceVersion);
  EXPECT_EQ(CELLMIRROR_TCP_FORCE_VALID, kTcpForceValid);
  EXPECT_EQ(CELLMIRROR_TCP_FORCE_TEST, kTcpForceTest);
  EXPECT_EQ(CELLMIRROR_TCP_FORCE_BEYOND_LIMIT, kTcpForceBeyondLimit);
}

TEST(DocumentedMemory, NamesOfPhasesAndFaults) {
  EXPECT_STREQ(cellmirror_phase_name(static_cast<std::uint32_t>(HapticPhase::closed)), "closed");
  EXPECT_STREQ(cellmirror_phase_name(static_cast<std::uint32_t>(HapticPhase::faulted)), "faulted");
  EXPECT_STREQ(cellmirror_phase_name(static_cast<std::uint32_t>(HapticPhase::faulted) + 1), "unknown");
  EXPECT_STREQ(cellmirror_fault_name(static_cast<std::uint32_t>(HapticFault::jump)), "jump");
  EXPECT_STREQ(cellmirror_fault_name(static_cast<std::uint32_t>(HapticFault::not_passive)), "not_passive");
  EXPECT_STREQ(cellmirror_fault_name(static_cast<std::uint32_t>(HapticFault::not_passive) + 1), "unknown");
}

// The functions of the C header against ours, in the same memory.
TEST(DocumentedMemory, CAndCppUnderstandEachOther) {
  alignas(8) std::array<std::byte, haptic_block_offset::kSize> memory{};
  cellmirror_haptic_force force{};
  EXPECT_EQ(cellmirror_read_force(memory.data(), memory.size(), &force), 0) << "no block yet";
  HapticOutput output;
  output.sequence = 5;
  output.phase = 4;
  output.force_D = {1, 2, 3};
  output.force_E = {4, 5, 6};
  output.joint_count = 4;
  output.joint_torques[3] = 0.5;
  prepare_haptic_block(memory, 4, 99);
  write_haptic_output(memory, output);
  EXPECT_EQ(cellmirror_read_force(memory.data(), 511, &force), 0);
  ASSERT_EQ(cellmirror_read_force(memory.data(), memory.size(), &force), 1);
  EXPECT_EQ(force.sequence, 5u);
  EXPECT_EQ(force.gateway, 99u);
  EXPECT_EQ(force.phase, 4u);
  EXPECT_EQ(force.force_device[2], 3);
  EXPECT_EQ(force.force[0], 4);
  EXPECT_EQ(force.joint_torque[3], 0.5f);

  cellmirror_haptic_sample sample{};
  sample.lock = 1234;  // ignored
  sample.sequence = 8;
  sample.flags = CELLMIRROR_HAPTIC_GOOD;
  sample.position[1] = 0.25;
  sample.orientation[3] = 1;
  sample.axis_count = 7;
  sample.axes[6] = 0.75;
  EXPECT_EQ(cellmirror_write_sample(memory.data(), 511, &sample), 0);
  ASSERT_EQ(cellmirror_write_sample(memory.data(), memory.size(), &sample), 1);
  HapticSample read;
  std::uint64_t last = 0;
  ASSERT_EQ(read_haptic_sample(memory, last, read), HapticRead::fresh);
  EXPECT_EQ(last, 2u);
  EXPECT_EQ(read.sequence, 8u);
  EXPECT_TRUE(read.valid);
  EXPECT_EQ(read.p_DH.y(), 0.25);
  EXPECT_EQ(read.q_DH.w(), 1);
  EXPECT_EQ(read.axes[6], 0.75);
}

TEST(DocumentedMemory, CReadsTheForceAtTheTcp) {
  alignas(8) std::array<std::byte, tcp_force_block_offset::kSize> memory{};
  cellmirror_tcp_force force{};
  EXPECT_EQ(cellmirror_read_tcp_force(memory.data(), memory.size(), &force), 0);
  TcpForce written;
  written.values = {1, 2, 3, 0.5f};
  written.robot = std::string_view("PUMA_762");
  write_tcp_force(memory, written);
  ASSERT_EQ(cellmirror_read_tcp_force(memory.data(), memory.size(), &force), 1);
  EXPECT_EQ(force.values[3], 0.5f);
  EXPECT_STREQ(force.robot, "PUMA_762");
}

}  // namespace
}  // namespace cellmirror
