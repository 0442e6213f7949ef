#include "rt_core/haptics/force_gate.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "rig.hpp"

namespace cellmirror::haptics {
namespace {

using Eigen::Vector3d;

constexpr double kNotANumber = std::numeric_limits<double>::quiet_NaN();
constexpr double kPeriod_s = 1e-3;
constexpr ForceLimits kLimits{.largest = 8.0, .largest_rate = 4000.0};

struct ForceGateTest : testing::Test {
  ForceGateTest() { sut.open(port); }

  bool write(const Vector3d& force) {
    HapticOutput output;
    output.force_D = force;
    return sut.write(output, kLimits, kPeriod_s);
  }

  test_rig::ScriptedPort port;
  ForceGate sut;
};

TEST_F(ForceGateTest, LimitsLengthAndRate) {
  EXPECT_TRUE(sut.limit({3, 0, 0}, kLimits, kPeriod_s).isApprox(Vector3d(3, 0, 0)));
  EXPECT_FALSE(sut.cut());
  EXPECT_TRUE(sut.limit({20, 0, 0}, kLimits, kPeriod_s).isApprox(Vector3d(7, 0, 0))) << "4 N a period";
  EXPECT_TRUE(sut.cut());
  EXPECT_TRUE(sut.limit({20, 0, 0}, kLimits, kPeriod_s).isApprox(Vector3d(8, 0, 0)));
  EXPECT_TRUE(sut.limit({kNotANumber, 0, 0}, kLimits, kPeriod_s).isApprox(Vector3d(4, 0, 0))) << "towards zero";
  sut.restart();
  EXPECT_TRUE(sut.limit({0, 8, 0}, kLimits, kPeriod_s).isApprox(Vector3d(0, 4, 0)));
}

TEST_F(ForceGateTest, PassesOnWhatIsWithinTheLimits) {
  EXPECT_TRUE(write({4, 0, 0}));
  EXPECT_TRUE(write({8, 0, 0}));
  EXPECT_EQ(port.output.force_D, Vector3d(8, 0, 0));
  EXPECT_TRUE(write(Vector3d::Zero())) << "a force is released at once";
  EXPECT_EQ(port.writes, 3);
}

TEST_F(ForceGateTest, WritesZeroForWhatIsTooLargeOrTooSudden) {
  EXPECT_FALSE(write({4.1, 0, 0}));
  EXPECT_EQ(port.output.force_D, Vector3d::Zero());
  EXPECT_TRUE(write({4, 0, 0}));
  EXPECT_TRUE(write({8, 0, 0}));
  EXPECT_FALSE(write({8.1, 0, 0}));
  EXPECT_EQ(port.output.force_D, Vector3d::Zero());
  EXPECT_FALSE(write({8, 0, 0})) << "the device has had zero since";
}

TEST_F(ForceGateTest, OneValueThatIsNoNumberTakesAllForcesAndTorques) {
  HapticOutput good;
  good.force_D = {1, 2, 3};
  good.force_E = {1, 2, 3};
  good.torque_D = {0.1, 0.2, 0.3};
  good.gripper_torque = 0.4;
  good.joint_torques.fill(0.5);
  for (int which = 0; which < 5; ++which) {
    HapticOutput output = good;
    if (which == 0) output.force_D.y() = kNotANumber;
    if (which == 1) output.force_E.z() = kNotANumber;
    if (which == 2) output.torque_D.x() = std::numeric_limits<double>::infinity();
    if (which == 3) output.gripper_torque = kNotANumber;
    if (which == 4) output.joint_torques.back() = -std::numeric_limits<double>::infinity();
    EXPECT_FALSE(sut.admits(output, kLimits, kPeriod_s));
    EXPECT_FALSE(sut.write(output, kLimits, kPeriod_s));
    EXPECT_EQ(port.output.force_D, Vector3d::Zero());
    EXPECT_EQ(port.output.force_E, Vector3d::Zero());
    EXPECT_EQ(port.output.torque_D, Vector3d::Zero());
    EXPECT_EQ(port.output.gripper_torque, 0.0);
    EXPECT_EQ(port.output.joint_torques, JointValues{});
  }
  EXPECT_TRUE(sut.write(good, kLimits, kPeriod_s));
  EXPECT_EQ(port.output.joint_torques, good.joint_torques);
}

}  // namespace
}  // namespace cellmirror::haptics
