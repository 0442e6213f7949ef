#include "ipc/wire/tcp_force_block.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <string>
#include <vector>

namespace cellmirror {
namespace {

namespace at = tcp_force_block_offset;

struct alignas(64) Block {
  std::array<std::byte, at::kSize> bytes{};
  [[nodiscard]] std::span<std::byte> memory() { return bytes; }
};

void expect_bytes(const Block& block, std::size_t offset, const std::vector<int>& wanted) {
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    EXPECT_EQ(std::to_integer<int>(block.bytes[offset + i]), wanted[i]) << "at " << offset + i;
  }
}

TcpForce example() {
  TcpForce force;
  force.values = {1, -2, 0.5f, 0.25f};
  force.sequence = 258;
  force.time.ns = 1'000'000'000;
  force.flags = kTcpForceValid | kTcpForceTest;
  force.process = 0x01020304;
  force.robot = std::string_view("PUMA");
  return force;
}

TEST(TcpForceBlock, IsWhatTheLayoutSays) {
  Block block;
  write_tcp_force(block.memory(), example());
  expect_bytes(block, at::kValues, {0, 0, 0x80, 0x3f, 0, 0, 0, 0xc0, 0, 0, 0, 0x3f, 0, 0, 0x80, 0x3e});
  expect_bytes(block, at::kMagic, {'C', 'M', 'T', 'F', 1, 0, 192, 0});
  expect_bytes(block, at::kLock, {2, 0, 0, 0, 0, 0, 0, 0, 2, 1, 0, 0, 0, 0, 0, 0, 0, 0xca, 0x9a, 0x3b, 0, 0, 0, 0});
  expect_bytes(block, at::kFlags, {3, 0, 0, 0, 4, 3, 2, 1});
  expect_bytes(block, at::kRobot, {'P', 'U', 'M', 'A', 0, 0});
  for (std::size_t i = 16; i < 64; ++i) EXPECT_EQ(block.bytes[i], std::byte{0}) << i;
}

TEST(TcpForceBlock, ComesBackAsItWas) {
  Block block;
  write_tcp_force(block.memory(), example());
  TcpForce sut;
  ASSERT_TRUE(read_tcp_force(block.memory(), sut));
  EXPECT_EQ(sut.values, example().values);
  EXPECT_EQ(sut.sequence, 258u);
  EXPECT_EQ(sut.time.ns, 1'000'000'000);
  EXPECT_EQ(sut.flags, kTcpForceValid | kTcpForceTest);
  EXPECT_EQ(sut.process, 0x01020304u);
  EXPECT_EQ(sut.robot.view(), "PUMA");
}

TEST(TcpForceBlock, LongNamesAreCutBeforeTheZero) {
  Block block;
  TcpForce force = example();
  force.robot = std::string_view(std::string(80, 'x'));
  write_tcp_force(block.memory(), force);
  EXPECT_EQ(block.bytes[at::kRobot + 63], std::byte{0});
  TcpForce sut;
  ASSERT_TRUE(read_tcp_force(block.memory(), sut));
  EXPECT_EQ(sut.robot.view(), std::string(63, 'x'));
}

TEST(TcpForceBlock, NameWithoutAZeroEndsWithItsField) {
  Block block;
  write_tcp_force(block.memory(), example());
  std::memset(block.bytes.data() + at::kRobot, 'y', 64);
  TcpForce sut;
  ASSERT_TRUE(read_tcp_force(block.memory(), sut));
  EXPECT_EQ(sut.robot.view(), std::string(64, 'y'));
}

TEST(TcpForceBlock, ValuesThatAreNoNumbersAreZeroAndNotValid) {
  for (const float bad : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
    Block block;
    TcpForce force = example();
    force.values[3] = bad;
    write_tcp_force(block.memory(), force);
    TcpForce sut;
    ASSERT_TRUE(read_tcp_force(block.memory(), sut));
    EXPECT_EQ(sut.values, (std::array<float, 4>{}));
    EXPECT_EQ(sut.flags, kTcpForceTest);
  }
}

TEST(TcpForceBlock, SmallMemoriesHoldTheValuesOnly) {
  for (const std::size_t size : {std::size_t{0}, std::size_t{15}, std::size_t{16}, std::size_t{191}}) {
    Block block;
    block.bytes.fill(std::byte{0xaa});
    const auto memory = block.memory().first(size);
    write_tcp_force(memory, example());
    const std::size_t written = std::min<std::size_t>(size / 4 * 4, 16);
    for (std::size_t i = written; i < at::kSize; ++i) ASSERT_EQ(block.bytes[i], std::byte{0xaa}) << size << ": " << i;
    if (written == 16) expect_bytes(block, 0, {0, 0, 0x80, 0x3f, 0, 0, 0, 0xc0, 0, 0, 0, 0x3f, 0, 0, 0x80, 0x3e});
    TcpForce sut;
    EXPECT_FALSE(read_tcp_force(memory, sut));
  }
}

TEST(TcpForceBlock, TornAndForeignBlocksAreNotRead) {
  for (const std::size_t wrong : {at::kMagic, at::kVersion, at::kBytes, at::kLock}) {
    Block block;
    write_tcp_force(block.memory(), example());
    block.bytes[wrong] ^= std::byte{1};
    TcpForce sut;
    EXPECT_FALSE(read_tcp_force(block.memory(), sut)) << wrong;
    EXPECT_EQ(sut.sequence, 0u);
  }
}

}  // namespace
}  // namespace cellmirror
