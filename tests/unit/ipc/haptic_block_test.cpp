#include "ipc/wire/haptic_block.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <vector>

#include "rt_core/ports/haptic_state.hpp"

namespace cellmirror {
namespace {

namespace at = haptic_block_offset;

struct alignas(64) Block {
  std::array<std::byte, at::kSize> bytes{};
  [[nodiscard]] std::span<std::byte> memory() { return bytes; }
};

void expect_bytes(const Block& block, std::size_t offset, const std::vector<int>& wanted) {
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    EXPECT_EQ(std::to_integer<int>(block.bytes[offset + i]), wanted[i]) << "at " << offset + i;
  }
}
void put(Block& block, std::size_t offset, const std::vector<int>& bytes) {
  for (std::size_t i = 0; i < bytes.size(); ++i) block.bytes[offset + i] = static_cast<std::byte>(bytes[i]);
}
void put_lock(Block& block, std::size_t offset, std::uint64_t lock) {
  std::memcpy(block.bytes.data() + offset, &lock, sizeof lock);
}
std::uint64_t lock_of(const Block& block, std::size_t offset) {
  std::uint64_t lock = 0;
  std::memcpy(&lock, block.bytes.data() + offset, sizeof lock);
  return lock;
}

HapticOutput example_output() {
  HapticOutput output;
  output.sequence = 0x0102030405060708;
  output.time.ns = 1'000'000'000;  // 0x3b9aca00
  output.period = Nanoseconds(1'000'000);
  output.answers = 7;
  output.phase = 4;
  output.fault = 0;
  output.force_E = {1, -2, 0.5};
  output.force_D = {-1, 2, 0.25};
  output.torque_D = {0, 0, 1};
  output.gripper_torque = -0.5;
  output.joint_count = 4;
  output.joint_torques[0] = 1;
  output.joint_torques[3] = -1;
  output.joint_torques[4] = 99;  // of no joint
  output.max_force = 8;
  return output;
}

// IEEE 754 by hand: 1 = 3f800000 / 3ff0000000000000, -2 = c0000000 / c0..., 0.5 = 3f000000 / 3fe0..., 0.25 = 3fd0...
TEST(HapticBlock, IsWhatTheLayoutSays) {
  Block block;
  prepare_haptic_block(block.memory(), 4, 0x01020304);
  write_haptic_output(block.memory(), example_output());
  expect_bytes(block, at::kForce, {0, 0, 0x80, 0x3f, 0, 0, 0, 0xc0, 0, 0, 0, 0x3f});
  expect_bytes(block, at::kJointTorque, {0, 0, 0x80, 0x3f, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0x80, 0xbf, 0, 0, 0, 0});
  expect_bytes(block, at::kMagic, {'C', 'M', 'H', 'P', 1, 0, 4, 0, 0, 2, 0, 0, 4, 3, 2, 1});
  expect_bytes(block, at::kForceLock, {4, 0, 0, 0, 0, 0, 0, 0, 8, 7, 6, 5, 4, 3, 2, 1});
  expect_bytes(block, at::kForceTime, {0, 0xca, 0x9a, 0x3b, 0, 0, 0, 0});
  expect_bytes(block, at::kPeriod, {0x40, 0x42, 0x0f, 0, 0, 0, 0, 0});
  expect_bytes(block, at::kAnswers, {7, 0, 0, 0, 0, 0, 0, 0, 4, 0, 0, 0, 0, 0, 0, 0});
  expect_bytes(block, at::kForceD,
               {0, 0, 0, 0, 0, 0, 0xf0, 0xbf, 0, 0, 0, 0, 0, 0, 0, 0x40, 0, 0, 0, 0, 0, 0, 0xd0, 0x3f});
  expect_bytes(block, at::kTorqueD + 16, {0, 0, 0, 0, 0, 0, 0xf0, 0x3f});
  expect_bytes(block, at::kGripperTorque, {0, 0, 0, 0, 0, 0, 0xe0, 0xbf});
  expect_bytes(block, at::kMaxForce, {0, 0, 0, 0, 0, 0, 0x20, 0x40});
  for (std::size_t i = 256; i < at::kSize; ++i)
    EXPECT_EQ(block.bytes[i], std::byte{0}) << "the device's section, " << i;
}

TEST(HapticBlock, ReadsASampleOfAnotherProgram) {
  Block block;
  put(block, at::kDeviceLock, {2, 0, 0, 0, 0, 0, 0, 0, 5, 0, 0, 0, 0, 0, 0, 0});
  put(block, at::kDeviceTime, {0, 0xca, 0x9a, 0x3b, 0, 0, 0, 0});
  put(block, at::kDeviceProcess, {0x39, 0x30, 0, 0, 1, 0, 0, 0, 0x05, 0, 0, 0x80, 2, 0, 0, 0});
  put(block, at::kPosition + 6, {0xf0, 0x3f});
  put(block, at::kPosition + 14, {0, 0xc0});
  put(block, at::kOrientation + 24 + 6, {0xf0, 0x3f});  // w
  put(block, at::kGripper + 6, {0xe0, 0x3f});
  put(block, at::kAxes + 8 + 6, {0xd0, 0x3f});
  put(block, at::kAxes + 16 + 6, {0xf0, 0x3f});  // beyond the count
  std::uint64_t last = 0;
  HapticSample sut;
  ASSERT_EQ(read_haptic_sample(block.memory(), last, sut), HapticRead::fresh);
  EXPECT_EQ(last, 2u);
  EXPECT_EQ(sut.sequence, 5u);
  EXPECT_EQ(sut.writes, 1u);
  EXPECT_EQ(sut.time.ns, 1'000'000'000);
  EXPECT_EQ(sut.writer, 12345u);
  EXPECT_TRUE(sut.valid);
  EXPECT_EQ(sut.buttons, 0x80000005u);
  EXPECT_EQ(sut.axis_count, 2);
  EXPECT_EQ(sut.p_DH, Eigen::Vector3d(1, -2, 0));
  EXPECT_EQ(sut.q_DH.coeffs(), Eigen::Vector4d(0, 0, 0, 1));
  EXPECT_EQ(sut.gripper, 0.5);
  EXPECT_EQ(sut.axes, (std::array<double, kMaxHapticAxes>{0, 0.25}));
  EXPECT_EQ(read_haptic_sample(block.memory(), last, sut), HapticRead::unchanged);
}

TEST(HapticBlock, SamplesAndOutputsComeBackAsTheyWere) {
  Block block;
  HapticSample sample;
  sample.sequence = 9;
  sample.time.ns = 3;
  sample.writer = 77;
  sample.valid = true;
  sample.buttons = 3;
  sample.axis_count = 7;
  sample.p_DH = {0.1, 0.2, 0.3};
  sample.q_DH = Eigen::Quaterniond(0.5, -0.5, 0.5, -0.5);
  sample.gripper = 0.7;
  sample.axes = {1, 2, 3, 4, 5, 6, 7};
  write_haptic_sample(block.memory(), sample);
  std::uint64_t last = 0;
  HapticSample read;
  ASSERT_EQ(read_haptic_sample(block.memory(), last, read), HapticRead::fresh);
  EXPECT_EQ(read.sequence, 9u);
  EXPECT_EQ(read.time.ns, 3);
  EXPECT_EQ(read.writer, 77u);
  EXPECT_EQ(read.buttons, 3u);
  EXPECT_EQ(read.p_DH, sample.p_DH);
  EXPECT_EQ(read.q_DH.coeffs(), sample.q_DH.coeffs());
  EXPECT_EQ(read.gripper, 0.7);
  EXPECT_EQ(read.axes, sample.axes);

  prepare_haptic_block(block.memory(), 4, 1);
  write_haptic_output(block.memory(), example_output());
  HapticOutput output;
  ASSERT_TRUE(read_haptic_output(block.memory(), output));
  EXPECT_EQ(output.sequence, example_output().sequence);
  EXPECT_EQ(output.period, example_output().period);
  EXPECT_EQ(output.force_E, example_output().force_E);
  EXPECT_EQ(output.force_D, example_output().force_D);
  EXPECT_EQ(output.torque_D, example_output().torque_D);
  EXPECT_EQ(output.joint_count, 4);
  EXPECT_EQ(output.joint_torques[3], -1);
  EXPECT_EQ(output.joint_torques[4], 0);
}

TEST(HapticBlock, NothingIsReadWhereNoDeviceEverWrote) {
  Block block;
  prepare_haptic_block(block.memory(), 4, 1);
  std::uint64_t last = 0;
  HapticSample sut;
  EXPECT_EQ(read_haptic_sample(block.memory(), last, sut), HapticRead::none);
  EXPECT_EQ(last, 0u);
}

TEST(HapticBlock, AWriterThatDiedHalfWayIsTornUntilAnotherOneWrites) {
  Block block;
  put_lock(block, at::kDeviceLock, 7);
  std::uint64_t last = 6;
  HapticSample sut;
  sut.sequence = 42;
  EXPECT_EQ(read_haptic_sample(block.memory(), last, sut), HapticRead::torn);
  EXPECT_EQ(last, 6u);
  EXPECT_EQ(sut.sequence, 42u) << "nothing was read";
  write_haptic_sample(block.memory(), {});
  EXPECT_EQ(lock_of(block, at::kDeviceLock), 8u);
  EXPECT_EQ(read_haptic_sample(block.memory(), last, sut), HapticRead::fresh);

  put_lock(block, at::kForceLock, 3);
  prepare_haptic_block(block.memory(), 4, 1);
  HapticOutput output;
  EXPECT_TRUE(read_haptic_output(block.memory(), output)) << "the gateway that comes back heals its own section";
  put_lock(block, at::kForceLock, 3);
  EXPECT_FALSE(read_haptic_output(block.memory(), output));
}

TEST(HapticBlock, ImpossibleNumberOfAxesGivesASampleThatIsNotValid) {
  Block block;
  HapticSample sample;
  sample.valid = true;
  sample.axis_count = 3;
  write_haptic_sample(block.memory(), sample);
  put(block, at::kAxisCount, {8, 0, 0, 0});
  std::uint64_t last = 0;
  HapticSample sut;
  ASSERT_EQ(read_haptic_sample(block.memory(), last, sut), HapticRead::fresh);
  EXPECT_EQ(sut.axis_count, 0);
  EXPECT_FALSE(sut.valid);
}

// So that nobody's age overflows.
TEST(HapticBlock, TimesBeforeZeroAreNever) {
  Block block;
  HapticSample sample;
  sample.time.ns = std::numeric_limits<std::int64_t>::min();
  write_haptic_sample(block.memory(), sample);
  std::uint64_t last = 0;
  HapticSample sut;
  sut.time.ns = 5;
  ASSERT_EQ(read_haptic_sample(block.memory(), last, sut), HapticRead::fresh);
  EXPECT_FALSE(sut.time.known());
}

TEST(HapticBlock, ForcesThatAreNoNumbersAreWrittenAsZero) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  std::vector<HapticOutput> outputs(7, example_output());
  outputs[0].force_E[1] = kNan;
  outputs[1].force_D[2] = kInfinity;
  outputs[2].torque_D[0] = kNan;
  outputs[3].gripper_torque = -kInfinity;
  outputs[4].joint_torques[2] = kNan;
  outputs[5].force_E[0] = 1e39;  // infinite as float32
  outputs[6].max_force = kNan;
  for (std::size_t i = 0; i < outputs.size(); ++i) {
    Block block;
    prepare_haptic_block(block.memory(), 4, 1);
    write_haptic_output(block.memory(), outputs[i]);
    HapticOutput sut;
    ASSERT_TRUE(read_haptic_output(block.memory(), sut));
    EXPECT_EQ(sut.force_E, Eigen::Vector3d::Zero()) << i;
    EXPECT_EQ(sut.force_D, Eigen::Vector3d::Zero()) << i;
    EXPECT_EQ(sut.torque_D, Eigen::Vector3d::Zero()) << i;
    EXPECT_EQ(sut.gripper_torque, 0) << i;
    EXPECT_EQ(sut.joint_torques, JointValues{}) << i;
    EXPECT_EQ(sut.fault, static_cast<std::uint32_t>(HapticFault::not_finite)) << i;
    EXPECT_EQ(sut.sequence, outputs[i].sequence) << i;
    EXPECT_TRUE(std::isfinite(sut.max_force)) << i;
  }
}

TEST(HapticBlock, AFaultThatIsToldAlreadyStays) {
  Block block;
  prepare_haptic_block(block.memory(), 4, 1);
  HapticOutput output = example_output();
  output.fault = static_cast<std::uint32_t>(HapticFault::jump);
  output.force_D[0] = std::numeric_limits<double>::quiet_NaN();
  write_haptic_output(block.memory(), output);
  HapticOutput sut;
  ASSERT_TRUE(read_haptic_output(block.memory(), sut));
  EXPECT_EQ(sut.fault, static_cast<std::uint32_t>(HapticFault::jump));
}

// A memory of 1999 holds float32 values: what is behind it is not ours.
TEST(HapticBlock, SmallMemoriesHoldWhatFits) {
  for (const std::size_t size : {std::size_t{0}, std::size_t{3}, std::size_t{12}, std::size_t{14}, std::size_t{28},
                                 std::size_t{76}, std::size_t{128}, std::size_t{511}}) {
    Block block;
    block.bytes.fill(std::byte{0xaa});
    const auto memory = block.memory().first(size);
    prepare_haptic_block(memory, 4, 1);
    EXPECT_FALSE(restore_haptic_header(memory, 4, 1));
    write_haptic_output(memory, example_output());
    write_haptic_sample(memory, {});
    const std::size_t floats = std::min<std::size_t>(size / 4, 19);
    if (floats >= 3) expect_bytes(block, 0, {0, 0, 0x80, 0x3f, 0, 0, 0, 0xc0, 0, 0, 0, 0x3f});
    if (floats >= 7) expect_bytes(block, at::kJointTorque + 12, {0, 0, 0x80, 0xbf});
    for (std::size_t i = 4 * floats; i < at::kSize; ++i)
      ASSERT_EQ(block.bytes[i], std::byte{0xaa}) << size << ": " << i;
    std::uint64_t last = 0;
    HapticSample sample;
    EXPECT_EQ(read_haptic_sample(memory, last, sample), HapticRead::none);
    HapticOutput output;
    EXPECT_FALSE(read_haptic_output(memory, output));
    EXPECT_EQ(haptic_block_gateway(memory), 0u);
    end_haptic_block(memory);
    for (std::size_t i = 0; i < 4 * floats; ++i) ASSERT_EQ(block.bytes[i], std::byte{0});
  }
}

TEST(HapticBlock, MemoryThatIsNotAlignedHoldsNothing) {
  alignas(64) std::array<std::byte, at::kSize + 8> bytes{};
  const auto memory = std::span(bytes).subspan(4);
  prepare_haptic_block(memory, 4, 1);
  write_haptic_output(memory, example_output());
  EXPECT_EQ(bytes, (std::array<std::byte, at::kSize + 8>{}));
}

TEST(HapticBlock, OtherBlocksAndVersionsAreRefused) {
  for (const std::size_t wrong : {at::kMagic, at::kMagic + 3, at::kVersion, at::kVersion + 1}) {
    Block block;
    prepare_haptic_block(block.memory(), 4, 1);
    EXPECT_EQ(haptic_block_gateway(block.memory()), 1u);
    block.bytes[wrong] ^= std::byte{0x10};
    HapticOutput output;
    EXPECT_FALSE(read_haptic_output(block.memory(), output)) << wrong;
    EXPECT_EQ(haptic_block_gateway(block.memory()), 0u);
  }
}

TEST(HapticBlock, HeaderIsRestoredOnlyWhereItIsNotAsItWas) {
  Block block;
  prepare_haptic_block(block.memory(), 4, 99);
  EXPECT_FALSE(restore_haptic_header(block.memory(), 4, 99));
  block.bytes.fill(std::byte{0xff});
  EXPECT_TRUE(restore_haptic_header(block.memory(), 4, 99));
  expect_bytes(block, at::kMagic, {'C', 'M', 'H', 'P', 1, 0, 4, 0, 0, 2, 0, 0, 99, 0, 0, 0});
}

TEST(HapticBlock, EndsWithoutForceAndWithoutGateway) {
  Block block;
  prepare_haptic_block(block.memory(), 4, 99);
  write_haptic_output(block.memory(), example_output());
  write_haptic_sample(block.memory(), {});
  end_haptic_block(block.memory());
  EXPECT_EQ(haptic_block_gateway(block.memory()), 0u);
  HapticOutput sut;
  ASSERT_TRUE(read_haptic_output(block.memory(), sut));
  EXPECT_EQ(sut.force_E, Eigen::Vector3d::Zero());
  EXPECT_EQ(sut.force_D, Eigen::Vector3d::Zero());
  EXPECT_EQ(sut.sequence, example_output().sequence + 1);
  EXPECT_EQ(sut.phase, static_cast<std::uint32_t>(HapticPhase::closed));
  EXPECT_EQ(lock_of(block, at::kDeviceLock), 2u) << "the device's section is the device's";
}

}  // namespace
}  // namespace cellmirror
