// Stops, faults and what a drive does without its controller.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/unit/can_device/master.hpp"

namespace cellmirror::can {
namespace {

using enum Cia402State;

struct Safety : testing::Test {
  // At 2 rad/s.
  static void spin(DriveMaster& master) {
    EXPECT_EQ(master.write(0x6060, 0, 3, 1), 0U);
    EXPECT_EQ(master.write32(0x6083, 50000), 0U);
    EXPECT_EQ(master.write32(0x6084, 10000), 0U);
    EXPECT_EQ(master.write32(0x6085, 40000), 0U);
    master.enable();
    EXPECT_EQ(master.write32(0x60FF, 2000), 0U);
    master.run(200ms);
    ASSERT_NEAR(master.drive.joint_velocity(), 2, 0.02);
  }
  // How long it takes to stand [s].
  static double stops_within(DriveMaster& master) {
    const Timestamp start = master.now;
    while (std::abs(master.drive.joint_velocity()) > 0.02 && master.now - start < 2s) master.run(500us);
    return seconds(master.now - start);
  }
};

TEST_F(Safety, QuickStopUsesItsRamp) {
  DriveMaster master;
  spin(master);
  master.control(0x02);
  EXPECT_EQ(master.drive.state(), quick_stop_active);
  EXPECT_NEAR(stops_within(master), 0.05, 0.02);  // 2 rad/s at 40 rad/s2
  master.run(100ms);
  EXPECT_EQ(master.drive.state(), switch_on_disabled);
}

TEST_F(Safety, QuickStopWithOption6HoldsTheAxis) {
  DriveMaster master;
  EXPECT_EQ(master.write16(0x605A, 6), 0U);
  spin(master);
  master.control(0x02);
  master.run(300ms);
  EXPECT_EQ(master.drive.state(), quick_stop_active);
  EXPECT_TRUE(master.status(10)) << "stands";
  EXPECT_EQ(master.write32(0x60FF, 0), 0U);
  master.control(0x0F);
  EXPECT_EQ(master.drive.state(), operation_enabled);
}

TEST_F(Safety, DisableOperationUsesTheSlowDownRamp) {
  DriveMaster master;
  spin(master);
  master.control(0x07);
  EXPECT_EQ(master.drive.state(), operation_enabled);
  EXPECT_NEAR(stops_within(master), 0.2, 0.03);  // 2 rad/s at 10 rad/s2
  master.run(100ms);
  EXPECT_EQ(master.drive.state(), switched_on);
}

TEST_F(Safety, WithoutPowerTheBrakeHolds) {
  DriveMaster master;
  spin(master);
  master.control(0x00);
  EXPECT_EQ(master.drive.state(), switch_on_disabled);
  EXPECT_LT(stops_within(master), 0.02);
  EXPECT_EQ(master.object(0x6077), 0);
}

// Against the mechanical stop: the torque ends at its limit, the position stays behind.
TEST_F(Safety, FollowingErrorIsAFaultThatIsReset) {
  DriveConfig config = test_drive();
  config.stops = JointInterval{-1, 1};
  config.blocked_after = 0;
  DriveMaster master(config);
  master.mode(1);
  master.enable();
  master.receive(frame(0x000, {0x01, 0x05}));
  EXPECT_EQ(master.write32(0x607A, 3000), 0U);
  master.take();
  master.control(0x1F);
  master.run(2s);
  EXPECT_EQ(master.drive.state(), fault);
  EXPECT_EQ(master.object(0x603F), 0x8611);
  EXPECT_EQ(master.emergencies(), (std::vector<std::uint16_t>{0x8611}));
  EXPECT_EQ(master.object(0x1001), 0x21);
  EXPECT_EQ(master.object(0x1003, 0), 1);
  EXPECT_EQ(master.object(0x1003, 1), 0x8611);
  EXPECT_NEAR(master.drive.joint_position(), 1, 1e-9);
  master.control(0x00);
  master.control(0x80);
  EXPECT_EQ(master.emergencies(), (std::vector<std::uint16_t>{0x0000}));
  EXPECT_EQ(master.drive.state(), switch_on_disabled);
  EXPECT_EQ(master.object(0x603F), 0);
  EXPECT_EQ(master.object(0x1001), 0);
}

TEST_F(Safety, FollowingErrorIsNotWatchedWithTheLargestWindow) {
  DriveConfig config = test_drive();
  config.stops = JointInterval{-1, 1};
  config.blocked_after = 0;
  DriveMaster master(config);
  EXPECT_EQ(master.write32(0x6065, 0xFFFFFFFF), 0U);
  master.mode(1);
  master.enable();
  EXPECT_EQ(master.write32(0x607A, 3000), 0U);
  master.control(0x1F);
  master.run(2s);
  EXPECT_EQ(master.drive.state(), operation_enabled);
  EXPECT_TRUE(master.status(11)) << "the current limit is an internal limit";
  EXPECT_EQ(master.object(0x6077), 3000) << "thousandths: three times the rated torque";
}

TEST_F(Safety, AWeakMotorLagsBehind) {
  DriveConfig config = test_drive();
  config.rated_torque = 3;
  config.peak_torque = 1;
  DriveMaster weak(config);
  weak.mode(1);
  EXPECT_EQ(weak.write32(0x6081, 10000), 0U);
  EXPECT_EQ(weak.write32(0x6083, 20000), 0U);
  weak.enable();
  EXPECT_EQ(weak.write32(0x607A, 10000), 0U);
  weak.control(0x1F);
  weak.run(1s);
  EXPECT_EQ(weak.object(0x603F), 0x8611) << "3 Nm give 1 kg m2 3 rad/s2, not 20";
}

TEST_F(Safety, DryFrictionIsOvercome) {
  DriveConfig config = test_drive();
  config.coulomb_friction = 20;
  config.viscous_friction = 5;
  DriveMaster master(config);
  master.mode(1);
  master.enable();
  EXPECT_EQ(master.write32(0x607A, 1000), 0U);
  master.control(0x1F);
  EXPECT_TRUE(master.run_until(10, 3s));
  EXPECT_NEAR(master.drive.joint_position(), 1, 0.002);
}

TEST_F(Safety, ALostMasterIsAFault) {
  DriveMaster master;
  EXPECT_EQ(master.write(0x1016, 1, 0x007F0064, 4), 0U);  // node 127, 100 ms
  master.receive(frame(0x000, {0x01, 0x05}));
  spin(master);
  for (int i = 0; i < 5; ++i) {
    master.receive(frame(0x77F, {0x05}));
    master.run(90ms);
  }
  EXPECT_EQ(master.drive.state(), operation_enabled);
  master.take();
  master.run(300ms);
  EXPECT_EQ(master.emergencies(), (std::vector<std::uint16_t>{0x8130}));
  EXPECT_EQ(master.drive.state(), fault);
  EXPECT_EQ(master.drive.nmt_state(), NmtState::pre_operational);
  EXPECT_NEAR(master.drive.joint_velocity(), 0, 1e-9);
}

TEST_F(Safety, AReturningHeartbeatClearsTheErrorUnlessItIsAFault) {
  for (const int option : {0, 1, 2, 3}) {
    DriveMaster master;
    EXPECT_EQ(master.write16(0x6007, option), 0U);
    EXPECT_EQ(master.write(0x1016, 1, 0x007F0064, 4), 0U);
    master.receive(frame(0x000, {0x01, 0x05}));
    spin(master);
    master.receive(frame(0x77F, {0x05}));
    master.take();
    master.run(300ms);
    EXPECT_EQ(master.emergencies(), (std::vector<std::uint16_t>{0x8130})) << option;
    EXPECT_EQ(master.object(0x1001), 0x11) << option;
    master.take();
    master.receive(frame(0x77F, {0x05}));
    const bool is_fault = option == 1;
    EXPECT_EQ(master.object(0x1001), is_fault ? 0x11 : 0) << option;
    EXPECT_EQ(master.emergencies().size(), is_fault ? 0U : 1U) << option;
    if (is_fault) master.control(0x80);
    EXPECT_EQ(master.object(0x1001), 0) << option;
  }
}

TEST_F(Safety, NmtStopIsAFaultOfAMovingDriveByDefault) {
  for (const int option : {0, 1, 2, 3}) {
    DriveMaster master;
    EXPECT_EQ(master.write16(0x6007, option), 0U);
    master.receive(frame(0x000, {0x01, 0x05}));
    spin(master);
    master.receive(frame(0x000, {0x02, 0x05}));
    master.run(500ms);
    const Cia402State expected[] = {operation_enabled, fault, switch_on_disabled, switch_on_disabled};
    EXPECT_EQ(master.drive.state(), expected[option]) << option;
  }
}

TEST_F(Safety, NmtResetSwitchesOffAndKeepsThePosition) {
  DriveMaster master;
  spin(master);
  master.take();
  const double before = master.drive.joint_position();
  master.receive(frame(0x000, {0x81, 0x05}));
  EXPECT_EQ(master.take().front(), frame(0x705, {0x00}));
  master.run(100ms);
  EXPECT_EQ(master.drive.state(), switch_on_disabled);
  EXPECT_EQ(master.object(0x6060), 0);
  EXPECT_NEAR(master.drive.joint_position(), before, 0.05);
  EXPECT_NEAR(static_cast<double>(master.object(0x6064)), 1000 * master.drive.joint_position(), 1);
}

TEST_F(Safety, HasOnlyModesMethodsAndOptionsThatItSays) {
  DriveMaster master;
  constexpr std::uint32_t kInvalid = 0x0609'0030;
  for (const int mode : {-1, 2, 5, 11}) EXPECT_EQ(master.write(0x6060, 0, mode & 0xFF, 1), kInvalid) << mode;
  EXPECT_EQ(master.object(0x6502), 0x3ED);
  EXPECT_EQ(master.write(0x6098, 0, 15, 1), kInvalid);
  EXPECT_EQ(master.write16(0x605A, 3), kInvalid);
  EXPECT_EQ(master.write16(0x6086, 2), kInvalid);
  EXPECT_EQ(master.write32(0x6083, 0), 0x0609'0032U);
  EXPECT_EQ(master.write32(0x6064, 0), 0x0601'0002U);
}

TEST_F(Safety, MotionThatWasMissedIsNotMadeUpFor) {
  DriveMaster master;
  spin(master);
  const double before = master.drive.joint_position();
  master.now = master.now + 10s;
  master.drive.advance(master.now);
  EXPECT_NEAR(master.drive.joint_position() - before, 0.2, 0.02);
}

}  // namespace
}  // namespace cellmirror::can
