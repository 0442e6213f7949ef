// What the drive does in each mode of operation (CiA 402-2, 7 to 15), against closed forms.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/unit/can_device/master.hpp"

namespace cellmirror::can {
namespace {

constexpr int kProfilePosition = 1;
constexpr int kProfileVelocity = 3;
constexpr int kHoming = 6;
constexpr int kInterpolated = 7;
constexpr int kCyclicPosition = 8;
constexpr int kCyclicVelocity = 9;
constexpr int kCyclicTorque = 10;
constexpr int kTargetReached = 10;
constexpr int kInternalLimit = 11;
constexpr int kAcknowledged = 12;
constexpr int kError = 13;

struct Modes : testing::Test {
  DriveMaster master;

  // 2000 increments/s, 4000 increments/s2 up, 8000 down.
  void profile() {
    EXPECT_EQ(master.write32(0x6081, 2000), 0U);
    EXPECT_EQ(master.write32(0x6083, 4000), 0U);
    EXPECT_EQ(master.write32(0x6084, 8000), 0U);
  }
  void set_point(std::int32_t target, std::uint16_t bits = 0) {
    EXPECT_EQ(master.write32(0x607A, target), 0U);
    master.control(static_cast<std::uint16_t>(0x1F | bits));
  }
};

// 0.5 s up (500), 1.125 s plateau (2250), 0.25 s down (250): 3000 increments.
TEST_F(Modes, ProfilePositionMovesInATrapezoid) {
  profile();
  master.mode(kProfilePosition);
  master.enable();
  set_point(3000);
  EXPECT_TRUE(master.status(kAcknowledged));
  EXPECT_FALSE(master.status(kTargetReached));
  master.control(0x0F);
  EXPECT_FALSE(master.status(kAcknowledged));
  master.run(500ms);
  EXPECT_NEAR(static_cast<double>(master.object(0x6062)), 500, 5);
  EXPECT_NEAR(static_cast<double>(master.object(0x6064)), 500, 25);
  EXPECT_NEAR(static_cast<double>(master.object(0x606C)), 2000, 60);
  EXPECT_FALSE(master.run_until(kTargetReached, 1360ms)) << "the profile takes 1.875 s";
  EXPECT_TRUE(master.run_until(kTargetReached, 100ms));
  EXPECT_NEAR(static_cast<double>(master.object(0x6064)), 3000, 2);
  EXPECT_NEAR(master.drive.joint_position(), 3.0, 0.002);
}

TEST_F(Modes, ProfilePositionTakesOneSetPointWhileAnotherIsUnderWay) {
  profile();
  master.mode(kProfilePosition);
  master.enable();
  set_point(1000);
  master.control(0x0F);
  set_point(500);
  EXPECT_TRUE(master.status(kAcknowledged));
  master.control(0x0F);
  EXPECT_TRUE(master.status(kAcknowledged)) << "no room for a third";
  set_point(-9000);
  master.control(0x0F);
  master.run(800ms);
  EXPECT_GT(master.object(0x6062), 900) << "the first one is carried out";
  EXPECT_FALSE(master.status(kTargetReached));
  EXPECT_TRUE(master.run_until(kTargetReached, 2s));
  EXPECT_NEAR(static_cast<double>(master.object(0x6064)), 500, 2);
  EXPECT_FALSE(master.status(kAcknowledged));
}

TEST_F(Modes, ProfilePositionReplacesASetPointImmediately) {
  profile();
  master.mode(kProfilePosition);
  master.enable();
  set_point(9000);
  master.control(0x0F);
  master.run(600ms);
  set_point(0, 0x20);
  master.control(0x0F);
  EXPECT_TRUE(master.run_until(kTargetReached, 3s));
  EXPECT_NEAR(static_cast<double>(master.object(0x6064)), 0, 2);
}

TEST_F(Modes, ProfilePositionAddsRelativeSetPoints) {
  profile();
  master.mode(kProfilePosition);
  master.enable();
  for (int i = 1; i <= 3; ++i) {
    set_point(200, 0x40);
    master.control(0x0F);
    EXPECT_TRUE(master.run_until(kTargetReached, 2s));
    EXPECT_NEAR(static_cast<double>(master.object(0x6064)), 200 * i, 2);
  }
}

TEST_F(Modes, ProfilePositionHaltsAndGoesOn) {
  profile();
  master.mode(kProfilePosition);
  master.enable();
  set_point(3000);
  master.run(600ms);
  master.control(0x10F);
  EXPECT_TRUE(master.run_until(kTargetReached, 1s)) << "with halt it says: stands";
  const std::int64_t at = master.object(0x6064);
  EXPECT_GT(at, 500);
  EXPECT_LT(at, 1200);
  master.run(500ms);
  EXPECT_NEAR(static_cast<double>(master.object(0x6064)), static_cast<double>(at), 3);
  master.control(0x0F);
  EXPECT_FALSE(master.status(kTargetReached));
  EXPECT_TRUE(master.run_until(kTargetReached, 3s));
  EXPECT_NEAR(static_cast<double>(master.object(0x6064)), 3000, 2);
}

TEST_F(Modes, ProfilePositionStopsAtTheSoftwareLimit) {
  EXPECT_EQ(master.write(0x607D, 2, 1500, 4), 0U);
  master.mode(kProfilePosition);
  master.enable();
  set_point(5000);
  EXPECT_TRUE(master.status(kInternalLimit));
  EXPECT_TRUE(master.run_until(kTargetReached, 3s));
  EXPECT_NEAR(static_cast<double>(master.object(0x6064)), 1500, 2);
}

// A controlword and a target in one PDO are one command, in whatever order they are mapped.
TEST_F(Modes, ASetPointByPdoHasTheTargetOfThatPdo) {
  EXPECT_EQ(master.write(0x1401, 2, 255, 1), 0U);
  master.mode(kProfilePosition);
  master.receive(frame(0x000, {0x01, 0x05}));
  master.enable();
  master.receive(frame(0x305, {0x1F, 0x00, 0xE8, 0x03, 0x00, 0x00}));
  EXPECT_TRUE(master.run_until(kTargetReached, 3s));
  EXPECT_NEAR(static_cast<double>(master.object(0x6064)), 1000, 2);
}

TEST_F(Modes, ProfileVelocityRampsAndReportsIt) {
  profile();
  master.mode(kProfileVelocity);
  master.enable();
  master.run(50ms);
  EXPECT_TRUE(master.status(kAcknowledged)) << "bit 12: speed is zero";
  EXPECT_EQ(master.write32(0x60FF, -1000), 0U);
  master.run(125ms);
  EXPECT_NEAR(static_cast<double>(master.object(0x606B)), -500, 3);
  EXPECT_NEAR(static_cast<double>(master.object(0x606C)), -500, 40);
  EXPECT_FALSE(master.status(kTargetReached));
  EXPECT_FALSE(master.status(kAcknowledged));
  EXPECT_TRUE(master.run_until(kTargetReached, 300ms));
  EXPECT_NEAR(static_cast<double>(master.object(0x606C)), -1000, 100) << "within the window";
  master.control(0x10F);
  EXPECT_TRUE(master.run_until(kAcknowledged, 500ms));
  master.control(0x0F);
  master.run(500ms);
  EXPECT_NEAR(static_cast<double>(master.object(0x606C)), -1000, 10);
}

TEST_F(Modes, ProfileVelocityStopsBeforeTheSoftwareLimit) {
  profile();
  EXPECT_EQ(master.write(0x607D, 2, 1500, 4), 0U);
  master.mode(kProfileVelocity);
  master.enable();
  EXPECT_EQ(master.write32(0x60FF, 2000), 0U);
  master.run(3s);
  EXPECT_NEAR(static_cast<double>(master.object(0x6064)), 1500, 10);
  EXPECT_TRUE(master.status(kInternalLimit));
  EXPECT_EQ(master.object(0x606C), 0);
}

TEST_F(Modes, CyclicSynchronousPositionInterpolatesFromTargetToTarget) {
  master.mode(kCyclicPosition);
  EXPECT_EQ(master.write(0x60C2, 1, 4, 1), 0U);
  master.receive(frame(0x000, {0x01, 0x05}));
  master.enable();
  double largest = 0;
  for (int i = 0; i <= 500; ++i) {
    const auto target = static_cast<std::int32_t>(std::lround(1000 * (1 - std::cos(i * 0.004 * 2))));
    CanFrame rpdo = frame(0x305, {0x0F, 0x00, 0, 0, 0, 0});
    put_le(std::span(rpdo.data).subspan(2), static_cast<std::uint32_t>(target), 4);
    master.receive(rpdo);
    master.receive(frame(0x080, {}));
    master.run(4ms);
    if (i > 5) largest = std::max(largest, std::abs(static_cast<double>(master.object(0x6064) - target)));
  }
  EXPECT_LT(largest, 8) << "increments; 1000 are the amplitude";
  EXPECT_TRUE(master.status(kAcknowledged)) << "bit 12: it follows";
}

TEST_F(Modes, CyclicSynchronousPositionStandsUntilATargetComes) {
  master.mode(kCyclicPosition);
  EXPECT_EQ(master.write32(0x607A, 20000), 0U);
  master.enable();
  master.run(200ms);
  EXPECT_EQ(master.object(0x6064), 0);
}

TEST_F(Modes, CyclicSynchronousVelocityFollowsAtOnce) {
  master.mode(kCyclicVelocity);
  master.enable();
  EXPECT_EQ(master.write32(0x60FF, 1500), 0U);
  EXPECT_EQ(master.write32(0x60B1, 500), 0U);
  master.run(100ms);
  EXPECT_NEAR(static_cast<double>(master.object(0x606C)), 2000, 20);
}

// 10 % of 100 Nm on 1 kg m2: 10 rad/s2.
TEST_F(Modes, CyclicSynchronousTorqueAccelerates) {
  master.mode(kCyclicTorque);
  master.enable();
  EXPECT_EQ(master.write16(0x6071, 100), 0U);
  master.run(200ms);
  EXPECT_NEAR(master.drive.joint_velocity(), 2.0, 0.01);
  EXPECT_NEAR(master.drive.joint_position(), 0.2, 0.01);
  EXPECT_EQ(master.object(0x6077), 100);
}

TEST_F(Modes, CyclicSynchronousTorqueEndsAtTheLargestVelocity) {
  master.mode(kCyclicTorque);
  EXPECT_EQ(master.write32(0x607F, 1000), 0U);
  master.enable();
  EXPECT_EQ(master.write16(0x6071, 100), 0U);
  master.run(1s);
  EXPECT_NEAR(master.drive.joint_velocity(), 1.0, 0.05);
}

TEST_F(Modes, InterpolatedPositionMovesWhileItsBitIsSet) {
  master.mode(kInterpolated);
  master.enable();
  EXPECT_EQ(master.write(0x60C1, 1, 100, 4), 0U);
  master.run(50ms);
  EXPECT_EQ(master.object(0x6062), 0);
  EXPECT_FALSE(master.status(kAcknowledged));
  master.control(0x1F);
  EXPECT_TRUE(master.status(kAcknowledged));
  EXPECT_EQ(master.write(0x60C1, 1, 100, 4), 0U);
  master.run(300ms);
  EXPECT_NEAR(static_cast<double>(master.object(0x6064)), 100, 2);
}

TEST_F(Modes, HomingAtTheCurrentPosition) {
  profile();
  master.mode(kProfilePosition);
  master.enable();
  set_point(700);
  EXPECT_TRUE(master.run_until(kTargetReached, 2s));
  master.control(0x0F);
  EXPECT_EQ(master.write(0x6098, 0, 37, 1), 0U);
  EXPECT_EQ(master.write32(0x607C, -250), 0U);
  master.mode(kHoming);
  EXPECT_FALSE(master.status(kAcknowledged));
  master.control(0x1F);
  EXPECT_TRUE(master.run_until(kTargetReached, 1s));
  EXPECT_TRUE(master.status(kAcknowledged)) << "bit 12: attained";
  EXPECT_NEAR(static_cast<double>(master.object(0x6064)), 250, 2) << "zero is the home offset beyond home";
  EXPECT_NEAR(master.drive.joint_position(), 0.7, 0.002) << "the joint has not moved";
}

struct HomingMode : testing::Test {
  static DriveConfig config() {
    DriveConfig drive = test_drive();
    drive.home_switch = JointInterval{1, 1.5};
    drive.limit_switches = JointInterval{-3, 3};
    drive.encoder_increments = 1000;
    return drive;
  }
  DriveMaster master{config()};

  void start(int method) {
    EXPECT_EQ(master.write(0x6098, 0, method, 1), 0U);
    EXPECT_EQ(master.write(0x6099, 1, 2000, 4), 0U);
    EXPECT_EQ(master.write(0x6099, 2, 200, 4), 0U);
    EXPECT_EQ(master.write32(0x609A, 20000), 0U);
    master.mode(kHoming);
    master.enable();
    master.control(0x1F);
  }
};

TEST_F(HomingMode, FindsTheEdgeOfTheHomeSwitch) {
  start(24);  // the cam's lower edge, crossed upwards
  EXPECT_FALSE(master.status(kTargetReached));
  EXPECT_TRUE(master.run_until(kAcknowledged, 10s));
  EXPECT_TRUE(master.run_until(kTargetReached, 1s));
  EXPECT_FALSE(master.status(kError));
  // Position 0 is the edge, wherever the axis has come to rest.
  EXPECT_NEAR(master.drive.joint_position() - static_cast<double>(master.object(0x6064)) / 1000, 1.0, 0.001);
  EXPECT_EQ(master.object(0x60FD) & 4, 4) << "the home switch is a digital input";
}

TEST_F(HomingMode, GoesOnWithTheNextIndexPulse) {
  start(2);  // one before the upper limit switch
  EXPECT_TRUE(master.run_until(kAcknowledged, 20s));
  EXPECT_TRUE(master.run_until(kTargetReached, 1s));
  EXPECT_NEAR(master.drive.joint_position() - static_cast<double>(master.object(0x6064)) / 1000, 2.0, 0.001);
}

TEST_F(HomingMode, IsInterruptedByItsBit) {
  start(24);
  master.run(100ms);
  master.control(0x0F);
  EXPECT_TRUE(master.run_until(kTargetReached, 1s));
  EXPECT_FALSE(master.status(kAcknowledged));
  EXPECT_FALSE(master.status(kError));
}

TEST(HomingWithoutSwitch, SetsTheErrorBit) {
  DriveMaster master;
  EXPECT_EQ(master.write(0x6098, 0, 24, 1), 0U);
  master.mode(kHoming);
  master.enable();
  master.control(0x1F);
  master.run(10ms);
  EXPECT_TRUE(master.status(kError));
  EXPECT_FALSE(master.status(kAcknowledged));
}

TEST_F(Modes, ADriveThatTurnsTheOtherWay) {
  DriveConfig config = test_drive();
  config.sign = -1;
  config.offset = 0.5;
  config.gear_motor = 10;
  config.start = 0.5;
  DriveMaster turned(config);
  turned.mode(kProfilePosition);
  turned.enable();
  EXPECT_EQ(turned.object(0x6064), 0);
  EXPECT_EQ(turned.write32(0x607A, 10000), 0U);
  turned.control(0x1F);
  EXPECT_TRUE(turned.run_until(kTargetReached, 3s));
  EXPECT_NEAR(turned.drive.joint_position(), -0.5, 0.002) << "10 turns of the motor are one of the shaft";
  EXPECT_EQ(turned.object(0x6091, 1), 10);
  EXPECT_EQ(turned.object(0x6092, 1), 10000);
}

}  // namespace
}  // namespace cellmirror::can
