// A drive whose joint meets an obstacle, and a motor with little torque.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/unit/can_device/master.hpp"

namespace cellmirror::can {
namespace {

using enum Cia402State;

struct Contact : testing::Test {
  // Profile velocity, increments/s.
  static void spin(DriveMaster& master, int velocity) {
    master.mode(3);
    EXPECT_EQ(master.write32(0x6083, 50000), 0U);
    master.enable();
    master.receive(frame(0x000, {0x01, 0x05}));
    EXPECT_EQ(master.write32(0x60FF, velocity), 0U);
    master.run(200ms);
    ASSERT_NEAR(master.drive.joint_velocity(), velocity / 1000.0, 0.02);
    master.take();
  }
  static void start_position(DriveMaster& master, int target) {
    master.mode(1);
    master.enable();
    master.receive(frame(0x000, {0x01, 0x05}));
    EXPECT_EQ(master.write32(0x607A, target), 0U);
    master.take();
    master.control(0x1F);
  }
};

TEST_F(Contact, StopsTheJointAndIsAFault) {
  DriveMaster master;
  spin(master, 2000);
  master.drive.set_bounds({.upper = 0});
  const double touched_at = master.drive.joint_position();
  const Timestamp touched = master.now;
  while (master.emergencies().empty() && master.now - touched < 1s) master.run(500us);
  EXPECT_LE(master.now - touched, 2ms);
  EXPECT_EQ(master.emergencies(), (std::vector<std::uint16_t>{0x7121}));
  EXPECT_EQ(master.object(0x1001), 0x21);
  EXPECT_EQ(master.object(0x6077), 3000) << "the torque is at its limit";
  master.run(500ms);
  EXPECT_EQ(master.drive.state(), fault);
  EXPECT_EQ(master.object(0x603F), 0x7121);
  EXPECT_NEAR(master.drive.joint_position(), touched_at, 1e-9);
}

TEST_F(Contact, AfterTheResetTheMasterDrivesOut) {
  DriveMaster master;
  spin(master, 1000);
  master.drive.set_bounds({.upper = 0});
  master.run(500ms);
  ASSERT_EQ(master.drive.state(), fault);
  const double touched_at = master.drive.joint_position();
  EXPECT_EQ(master.write32(0x60FF, -1000), 0U);
  master.control(0x00);
  master.control(0x80);
  master.enable();
  master.run(200ms);
  EXPECT_EQ(master.drive.state(), operation_enabled);
  EXPECT_LT(master.drive.joint_position(), touched_at - 0.1);
  EXPECT_EQ(master.object(0x603F), 0);
}

TEST_F(Contact, IntoTheContactAgainIsAFaultAgain) {
  DriveMaster master;
  spin(master, 1000);
  master.drive.set_bounds({.upper = 0});
  master.run(500ms);
  master.control(0x00);
  master.control(0x80);
  master.enable();  // the target velocity is still there
  master.run(500ms);
  EXPECT_EQ(master.drive.state(), fault);
}

// The direction is the drive's for the controller, and the joint's for the obstacle.
TEST_F(Contact, OfADriveThatIsMountedTheOtherWay) {
  DriveConfig config = test_drive();
  config.sign = -1;
  DriveMaster master(config);
  master.mode(3);
  master.enable();
  EXPECT_EQ(master.write32(0x60FF, 1000), 0U);
  master.run(200ms);
  ASSERT_LT(master.drive.joint_velocity(), -0.9);
  master.drive.set_bounds({.upper = 0});
  master.run(100ms);
  EXPECT_EQ(master.drive.state(), operation_enabled) << "leaves the contact";
  master.drive.set_bounds({.lower = 0});
  master.run(500ms);
  EXPECT_EQ(master.object(0x603F), 0x7121);
}

TEST_F(Contact, WithoutTheWatchTheFollowingErrorIsTheFault) {
  DriveConfig config = test_drive();
  config.blocked_after = 0;
  DriveMaster master(config);
  EXPECT_EQ(master.object(0x2000), 0);
  start_position(master, 3000);
  master.run(200ms);
  master.drive.set_bounds({.upper = 0});
  master.run(50ms);
  EXPECT_GT(master.object(0x60F4), 50) << "the following error grows";
  EXPECT_EQ(master.drive.state(), operation_enabled);
  master.run(2s);
  EXPECT_EQ(master.drive.state(), fault);
  EXPECT_EQ(master.object(0x603F), 0x8611);
}

TEST_F(Contact, ALightTouchIsNoBlock) {
  DriveConfig config = test_drive();
  config.rated_torque = 500;  // 1 kg m2 and a velocity error of 0.1 rad/s: 25 Nm
  DriveMaster master(config);
  spin(master, 100);
  master.drive.set_bounds({.upper = 0});
  master.run(20ms);
  EXPECT_TRUE(master.drive.is_held_back());
  EXPECT_EQ(master.drive.state(), operation_enabled);
  master.drive.set_bounds({});
  master.run(100ms);
  EXPECT_NEAR(master.drive.joint_velocity(), 0.1, 0.01);
}

TEST_F(Contact, ATorqueThatIsCommandedMayPress) {
  DriveMaster master;
  master.mode(10);
  master.enable();
  EXPECT_EQ(master.write16(0x6071, 1500), 0U);
  master.drive.set_bounds({.upper = 0});
  master.run(500ms);
  EXPECT_EQ(master.drive.state(), operation_enabled);
  EXPECT_NEAR(master.drive.joint_torque(), 150, 1e-9);
  EXPECT_EQ(master.drive.joint_position(), 0);
}

TEST_F(Contact, TorqueLimitsActInTheirDirections) {
  DriveMaster master;
  EXPECT_EQ(master.object(0x60E0), 3000);
  EXPECT_EQ(master.object(0x60E1), 3000);
  EXPECT_EQ(master.write16(0x60E0, 500), 0U);
  EXPECT_EQ(master.write16(0x60E1, 200), 0U);
  master.mode(10);
  master.enable();
  EXPECT_EQ(master.write16(0x6071, 1500), 0U);
  master.run(10ms);
  EXPECT_EQ(master.object(0x6077), 500);
  EXPECT_TRUE(master.status(11));
  EXPECT_EQ(master.write16(0x6071, -1500), 0U);
  master.run(10ms);
  EXPECT_EQ(master.object(0x6077), -200);
  EXPECT_EQ(master.write16(0x6072, 100), 0U);
  master.run(10ms);
  EXPECT_EQ(master.object(0x6077), -100) << "the smallest limit counts";
}

TEST_F(Contact, TorqueLimitsOfADriveThatIsMountedTheOtherWay) {
  DriveConfig config = test_drive();
  config.sign = -1;
  DriveMaster master(config);
  EXPECT_EQ(master.write16(0x60E0, 500), 0U);
  master.mode(10);
  master.enable();
  EXPECT_EQ(master.write16(0x6071, 1500), 0U);
  master.run(10ms);
  EXPECT_EQ(master.object(0x6077), 500);
  EXPECT_NEAR(master.drive.joint_torque(), -50, 1e-9);
}

// Without an obstacle: the friction is greater than the torque.
TEST_F(Contact, AStallRaisesTheFollowingError) {
  DriveConfig config = test_drive();
  config.coulomb_friction = 30;
  DriveMaster master(config);
  EXPECT_EQ(master.write16(0x6072, 250), 0U);
  start_position(master, 5000);
  master.run(2s);
  EXPECT_EQ(master.object(0x603F), 0x8611);
  EXPECT_EQ(master.drive.state(), fault);
  EXPECT_EQ(master.drive.joint_position(), 0);
}

TEST_F(Contact, LittleTorqueAcceleratesSlowly) {
  DriveMaster strong;
  DriveMaster weak;
  EXPECT_EQ(weak.write16(0x60E0, 100), 0U);  // 10 Nm: 10 rad/s2
  for (DriveMaster* master : {&strong, &weak}) {
    EXPECT_EQ(master->write32(0x6065, 0xFFFFFFFF), 0U);
    start_position(*master, 5000);
    master->run(100ms);
  }
  EXPECT_GT(strong.drive.joint_velocity(), 2);
  EXPECT_NEAR(weak.drive.joint_velocity(), 1, 0.05);
}

}  // namespace
}  // namespace cellmirror::can
