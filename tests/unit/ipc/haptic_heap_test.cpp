#include <gtest/gtest.h>

#include <array>

#include "ipc/wire/haptic_block.hpp"
#include "rt_core/ports/haptic_state.hpp"
#include "rt_core/rt/allocation_guard.hpp"

namespace cellmirror {
namespace {

TEST(HapticBlock, ReadingAndWritingTakesNoHeap) {
  alignas(64) std::array<std::byte, haptic_block_offset::kSize> bytes{};
  const std::span<std::byte> memory(bytes);
  prepare_haptic_block(memory, 4, 1);
  HapticSample sample;
  HapticOutput output;
  output.joint_count = 4;
  output.force_E = {1, -2, 0.5};
  std::uint64_t last = 0;
  ASSERT_TRUE(AllocationGuard::armed());
  const AllocationGuard guard;
  write_haptic_sample(memory, sample);
  const HapticRead read = read_haptic_sample(memory, last, sample);
  restore_haptic_header(memory, 5, 1);
  write_haptic_output(memory, output);
  const bool felt = read_haptic_output(memory, output);
  end_haptic_block(memory);
  const std::uint64_t allocations = guard.allocations();
  EXPECT_EQ(allocations, 0U);
  EXPECT_EQ(read, HapticRead::fresh);
  EXPECT_TRUE(felt);
}

}  // namespace
}  // namespace cellmirror
