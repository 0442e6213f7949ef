// Profile torque, and set-points that the axis passes without a stop.
#include <gtest/gtest.h>

#include <algorithm>

#include "tests/unit/can_device/master.hpp"

namespace cellmirror::can {
namespace {

using enum Cia402State;

TEST(ProfileTorque, RampsToItsTarget) {
  DriveConfig config = test_drive();
  config.coulomb_friction = 200;  // holds the joint
  DriveMaster master(config);
  master.mode(4);
  EXPECT_EQ(master.write32(0x6087, 1000), 0U);  // the rated torque in a second
  master.enable();
  EXPECT_EQ(master.object(0x6061), 4);
  EXPECT_EQ(master.write16(0x6071, 500), 0U);
  master.run(250ms);
  EXPECT_NEAR(static_cast<double>(master.object(0x6077)), 250, 2);
  EXPECT_FALSE(master.status(10));
  master.run(260ms);
  EXPECT_EQ(master.object(0x6077), 500);
  EXPECT_TRUE(master.status(10));
  EXPECT_EQ(master.write16(0x6071, -100), 0U);
  master.run(700ms);
  EXPECT_EQ(master.object(0x6077), -100);
}

TEST(ProfileTorque, HaltRampsToZeroAndBack) {
  DriveConfig config = test_drive();
  config.coulomb_friction = 200;
  DriveMaster master(config);
  master.mode(4);
  EXPECT_EQ(master.write16(0x6071, 500), 0U);
  master.enable();
  master.run(200ms);
  EXPECT_EQ(master.object(0x6077), 500);
  master.control(0x010F);
  master.run(200ms);
  EXPECT_EQ(master.object(0x6077), 0);
  EXPECT_TRUE(master.status(10)) << "stands";
  master.control(0x000F);
  master.run(200ms);
  EXPECT_EQ(master.object(0x6077), 500);
}

TEST(ProfileTorque, TheVelocityIsLimited) {
  DriveMaster master;
  master.mode(4);
  EXPECT_EQ(master.write32(0x607F, 2000), 0U);
  EXPECT_EQ(master.write16(0x6071, 500), 0U);
  master.enable();
  master.run(2s);
  EXPECT_NEAR(master.drive.joint_velocity(), 2, 0.1);
  EXPECT_TRUE(master.status(11));
  EXPECT_EQ(master.drive.state(), operation_enabled);
}

struct SetPoints : testing::Test {
  // The axis is under way to 1000 and is given 2000; the lowest speed from then until it is past 1500.
  static double lowest_speed(std::uint16_t second) {
    DriveMaster master;
    master.mode(1);
    master.enable();
    EXPECT_EQ(master.write32(0x607A, 1000), 0U);
    master.control(0x001F);
    master.control(0x000F);
    master.run(200ms);
    EXPECT_EQ(master.write32(0x607A, 2000), 0U);
    master.control(second);
    double lowest = 100;
    for (int i = 0; i < 4000 && master.drive.joint_position() < 1.5; ++i) {
      master.run(500us);
      lowest = std::min(lowest, master.drive.joint_velocity());
    }
    EXPECT_TRUE(master.run_until(10, 2s));
    EXPECT_NEAR(master.drive.joint_position(), 2, 0.003);
    return lowest;
  }
};

TEST_F(SetPoints, AreStoppedAtWithoutBit9) { EXPECT_LT(lowest_speed(0x001F), 0.3); }

TEST_F(SetPoints, ArePassedWithBit9) { EXPECT_GT(lowest_speed(0x021F), 2.4); }

TEST_F(SetPoints, OneThatWasPassedMayLieBehindTheNext) {
  DriveMaster master;
  master.mode(1);
  master.enable();
  EXPECT_EQ(master.write32(0x607A, 1000), 0U);
  master.control(0x001F);
  master.control(0x000F);
  master.run(200ms);
  EXPECT_EQ(master.write32(0x607A, 0), 0U);
  master.control(0x021F);
  double farthest = 0;
  for (int i = 0; i < 4000; ++i) {
    master.run(500us);
    farthest = std::max(farthest, master.drive.joint_position());
  }
  EXPECT_GT(farthest, 1.0);
  EXPECT_LT(farthest, 1.1);
  EXPECT_NEAR(master.drive.joint_position(), 0, 0.003);
  EXPECT_TRUE(master.status(10));
}

TEST_F(SetPoints, HaltWhilePassingGoesOnAfterwards) {
  DriveMaster master;
  master.mode(1);
  master.enable();
  EXPECT_EQ(master.write32(0x607A, 1000), 0U);
  master.control(0x001F);
  master.control(0x000F);
  master.run(100ms);
  EXPECT_EQ(master.write32(0x607A, 2000), 0U);
  master.control(0x021F);
  master.run(50ms);
  master.control(0x010F);
  master.run(500ms);
  EXPECT_NEAR(master.drive.joint_velocity(), 0, 0.01);
  EXPECT_LT(master.drive.joint_position(), 1);
  master.control(0x000F);
  master.run(2s);
  EXPECT_NEAR(master.drive.joint_position(), 2, 0.003);
}

}  // namespace
}  // namespace cellmirror::can
