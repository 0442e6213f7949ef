#include "drivers/haptic/shared_memory_device.hpp"

#include <gtest/gtest.h>

#include <array>

#include "ipc/wire/haptic_block.hpp"

namespace cellmirror {
namespace {

class SharedMemoryDeviceTest : public ::testing::Test {
 protected:
  alignas(64) std::array<std::byte, haptic_block_offset::kSize> bytes_{};
  HapticSample sample_;
  HapticOutput output_;
};

TEST_F(SharedMemoryDeviceTest, CarriesSamplesAndForces) {
  haptic::SharedMemoryDevice sut(bytes_, 4, 99);
  EXPECT_EQ(haptic_block_gateway(bytes_), 99u);
  EXPECT_EQ(sut.read(sample_), HapticRead::none);
  sample_.sequence = 3;
  write_haptic_sample(bytes_, sample_);
  HapticSample read;
  EXPECT_EQ(sut.read(read), HapticRead::fresh);
  EXPECT_EQ(read.sequence, 3u);
  EXPECT_EQ(sut.read(read), HapticRead::unchanged);

  output_.force_D = {1, 2, 3};
  output_.joint_count = 4;
  sut.write(output_);
  HapticOutput felt;
  ASSERT_TRUE(read_haptic_output(bytes_, felt));
  EXPECT_EQ(felt.force_D, output_.force_D);
  EXPECT_EQ(sut.headers_restored(), 0u);
}

TEST_F(SharedMemoryDeviceTest, GoesOnWhenTheMemoryWasRenewed) {
  haptic::SharedMemoryDevice sut(bytes_, 4, 99);
  write_haptic_sample(bytes_, sample_);
  EXPECT_EQ(sut.read(sample_), HapticRead::fresh);
  bytes_.fill(std::byte{0});
  sut.write(output_);
  EXPECT_EQ(sut.headers_restored(), 1u);
  EXPECT_EQ(haptic_block_gateway(bytes_), 99u);
  EXPECT_EQ(sut.read(sample_), HapticRead::none) << "no device has found it yet";
  sample_.sequence = 4;
  write_haptic_sample(bytes_, sample_);
  write_haptic_sample(bytes_, sample_);
  EXPECT_EQ(sut.read(sample_), HapticRead::fresh);
}

TEST_F(SharedMemoryDeviceTest, LeavesNoForceBehind) {
  {
    haptic::SharedMemoryDevice sut(bytes_, 4, 99);
    output_.force_D = {1, 2, 3};
    sut.write(output_);
  }
  HapticOutput felt;
  ASSERT_TRUE(read_haptic_output(bytes_, felt));
  EXPECT_EQ(felt.force_D, Eigen::Vector3d::Zero());
  EXPECT_EQ(haptic_block_gateway(bytes_), 0u);
}

}  // namespace
}  // namespace cellmirror
