// Drives of continuous joints: the position wraps at the ends of its range, the axis continues.
#include <gtest/gtest.h>

#include <limits>

#include "tests/unit/can_device/master.hpp"

namespace cellmirror::can {
namespace {

constexpr double kHighest = std::numeric_limits<std::int32_t>::max();

DriveConfig turning_drive(double start) {
  DriveConfig config = test_drive();
  config.stops.reset();
  config.software_limits = DriveConfig().software_limits;
  config.start = start;
  return config;
}

struct Turning : testing::Test {
  // Starts near the highest value of 32 bits: 1000 increments per rad.
  DriveMaster master{turning_drive(kHighest / 1000 - 2)};
};

TEST_F(Turning, ProfileVelocityContinuesBeyondTheEndOfTheCounter) {
  EXPECT_EQ(master.object(0x607D, 2), std::numeric_limits<std::int32_t>::max()) << "no limit";
  const double before = master.drive.joint_position();
  master.mode(3);
  master.enable();
  EXPECT_EQ(master.write32(0x60FF, 5000), 0U);
  master.run(2s);
  EXPECT_NEAR(master.drive.joint_velocity(), 5, 0.05);
  EXPECT_GT(master.drive.joint_position(), before + 8);
  EXPECT_LT(master.object(0x6064), 0) << "the counter has wrapped";
  const double all = 4'294'967'296.0;
  EXPECT_NEAR(static_cast<double>(master.object(0x6064)), 1000 * master.drive.joint_position() - all, 2);
  EXPECT_FALSE(master.status(11)) << "no internal limit";
}

TEST_F(Turning, ACyclicTargetBeyondTheEndIsReachedByTheShorterWay) {
  master.mode(8);
  master.enable();
  const double before = master.drive.joint_position();
  std::int64_t target = master.object(0x6064);
  for (int i = 0; i < 1000; ++i) {
    target += 5;
    master.run(1ms);
    const auto wrapped = static_cast<std::int32_t>(static_cast<std::uint32_t>(target));
    EXPECT_EQ(master.write32(0x607A, wrapped), 0U);
  }
  master.run(200ms);
  EXPECT_NEAR(master.drive.joint_position(), before + 5, 0.01);
  EXPECT_EQ(master.drive.state(), Cia402State::operation_enabled);
}

struct TurningRange : testing::Test {
  TurningRange() {
    EXPECT_EQ(master.write(0x607B, 1, 0, 4), 0U);
    EXPECT_EQ(master.write(0x607B, 2, 5999, 4), 0U);
    EXPECT_EQ(master.write32(0x6081, 8000), 0U);
    master.mode(1);
    master.enable();
  }
  // Moves to the target; returns the distance in rad.
  double way_to(std::int64_t target) {
    const double before = master.drive.joint_position();
    EXPECT_EQ(master.write32(0x607A, target), 0U);
    master.control(0x0F);
    master.control(0x1F);
    EXPECT_TRUE(master.run_until(10, 20s));
    EXPECT_NEAR(static_cast<double>(master.object(0x6064)), static_cast<double>(target), 3);
    return master.drive.joint_position() - before;
  }
  DriveMaster master{turning_drive(0)};
};

TEST_F(TurningRange, PositionsStayInTheirRange) {
  master.mode(3);
  EXPECT_EQ(master.write32(0x60FF, -9000), 0U);
  for (int i = 0; i < 2000; ++i) {
    master.run(1ms);
    ASSERT_GE(master.object(0x6064), 0);
    ASSERT_LE(master.object(0x6064), 5999);
  }
  EXPECT_LT(master.drive.joint_position(), -12);
}

TEST_F(TurningRange, ThePositioningOptionSelectsTheDirectionToATarget) {
  EXPECT_NEAR(way_to(1000), 1, 0.01);
  EXPECT_NEAR(way_to(5500), 4.5, 0.01) << "as a linear axis";
  EXPECT_EQ(master.write(0x60F2, 0, 0xC0, 2), 0U);
  EXPECT_NEAR(way_to(500), 1, 0.01) << "the shortest way";
  EXPECT_EQ(master.write(0x60F2, 0, 0x40, 2), 0U);
  EXPECT_NEAR(way_to(1500), -5, 0.01) << "in negative direction only";
  EXPECT_EQ(master.write(0x60F2, 0, 0x80, 2), 0U);
  EXPECT_NEAR(way_to(1000), 5.5, 0.01) << "in positive direction only";
  EXPECT_NEAR(way_to(1000), 0, 0.01) << "it stands there already";
  EXPECT_NEAR(way_to(2333), 1.333, 0.01);
  EXPECT_NEAR(way_to(2333), 0, 0.01);
  EXPECT_EQ(master.write(0x60F2, 0, 0x01, 2), 0x0609'0030U);
}

}  // namespace
}  // namespace cellmirror::can
