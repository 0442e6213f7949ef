// The couplings themselves, without an engine around them: what no command can ask for.
#include <gtest/gtest.h>

#include <span>
#include <vector>

#include "rt_core/engine/coupling.hpp"
#include "rt_core/engine/robot_slot.hpp"
#include "tests/unit/engine/commands.hpp"

namespace cellmirror::engine {
namespace {

std::vector<RobotSlot> robots(std::size_t count) {
  std::vector<RobotSlot> slots(count);
  for (RobotSlot& slot : slots) slot.add(robot_of(1, -1.0, 1.0));
  return slots;
}

Coupling first_joints(std::size_t master, std::size_t slave) {
  Coupling coupling;
  coupling.master = static_cast<std::uint8_t>(master);
  coupling.slave = static_cast<std::uint8_t>(slave);
  coupling.count = 1;
  coupling.max_velocity.fill(1.0);
  return coupling;
}

TEST(Couplings, SlotsPastTheEndAreNotTouched) {
  constexpr std::size_t kRobots = 3;
  auto slots = robots(kRobots);
  Couplings sut(kRobots);
  EXPECT_FALSE(sut.couple(first_joints(kRobots, 0), slots));
  EXPECT_FALSE(sut.couple(first_joints(0, kRobots), slots));
  EXPECT_FALSE(sut.uncouple(kRobots, slots));
  ASSERT_TRUE(sut.couple(first_joints(0, 2), slots));
  sut.remove(kRobots, slots);
  EXPECT_TRUE(slots[2].state().follow.follows());
  // The same where there is memory behind the end, so that a look past it shows without a sanitizer too.
  const std::span<RobotSlot> first_two = std::span(slots).first(2);
  EXPECT_FALSE(sut.uncouple(2, first_two));
  EXPECT_FALSE(sut.couple(first_joints(0, 2), first_two));
  EXPECT_FALSE(sut.couple(first_joints(2, 0), first_two));
  sut.remove(2, first_two);
  EXPECT_TRUE(slots[2].state().follow.follows());
}

TEST(Couplings, AValuePassesThroughAChainOf256RobotsWithinOneStep) {
  auto slots = robots(kMaxRobots);
  Couplings sut(kMaxRobots);
  for (std::size_t slave = kMaxRobots - 1; slave > 0; --slave)
    ASSERT_TRUE(sut.couple(first_joints(slave - 1, slave), slots));
  EXPECT_FALSE(sut.couple(first_joints(kMaxRobots - 1, 0), slots)) << "a circle";
  ASSERT_TRUE(slots[0].set_positions({0.0005}));
  const auto moved = sut.step(1e-3, slots);
  ASSERT_EQ(moved.size(), kMaxRobots - 1);
  EXPECT_EQ(moved.front(), 1);
  EXPECT_EQ(moved.back(), kMaxRobots - 1);
  EXPECT_DOUBLE_EQ(slots.back().state().joints[0].position, 0.0005);
  EXPECT_TRUE(sut.step(1e-3, slots).empty());
  sut.remove(100, slots);
  EXPECT_FALSE(slots[100].state().follow.follows());
  EXPECT_FALSE(slots[101].state().follow.follows());
  EXPECT_TRUE(slots[102].state().follow.follows());
}

}  // namespace
}  // namespace cellmirror::engine
