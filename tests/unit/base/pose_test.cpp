#include "rt_core/base/pose.hpp"

#include <gtest/gtest.h>

#include <numbers>
#include <random>

#include "rt_core/base/units.hpp"

namespace cellmirror {
namespace {

constexpr double kHalfTurn = std::numbers::pi;
constexpr double kExact = 1e-15;

TEST(Pose, RollPitchYawTurnAboutFixedAxesInThisOrder) {
  // Roll 90 degrees about x takes y to z; yaw 90 degrees about z then leaves it there and takes x to y.
  const Eigen::Matrix3d R = rotation_from_rpy(kHalfTurn / 2, 0, kHalfTurn / 2);
  EXPECT_LT((R * Eigen::Vector3d::UnitX() - Eigen::Vector3d::UnitY()).norm(), kExact);
  EXPECT_LT((R * Eigen::Vector3d::UnitY() - Eigen::Vector3d::UnitZ()).norm(), kExact);
  // Pitch acts between the two: R = Rz Ry Rx.
  const Eigen::Matrix3d S = rotation_from_rpy(0.3, -0.7, 1.1);
  const Eigen::Matrix3d expected =
      (Eigen::AngleAxisd(1.1, Eigen::Vector3d::UnitZ()) * Eigen::AngleAxisd(-0.7, Eigen::Vector3d::UnitY()) *
       Eigen::AngleAxisd(0.3, Eigen::Vector3d::UnitX()))
          .toRotationMatrix();
  EXPECT_LT((S - expected).norm(), kExact);
}

TEST(Pose, AnglesComeBackForRandomRotations) {
  std::mt19937 chance(1);
  std::uniform_real_distribution<double> roll_yaw(-kHalfTurn, kHalfTurn);
  std::uniform_real_distribution<double> pitch(-1.5, 1.5);
  for (int i = 0; i < 1000; ++i) {
    const Eigen::Vector3d rpy(roll_yaw(chance), pitch(chance), roll_yaw(chance));
    EXPECT_LT((rpy_from_rotation(rotation_from_rpy(rpy.x(), rpy.y(), rpy.z())) - rpy).norm(), 1e-12);
  }
}

TEST(Pose, AtGimbalLockTheRotationIsKept) {
  for (const double pitch : {kHalfTurn / 2, -kHalfTurn / 2}) {
    const Eigen::Matrix3d R = rotation_from_rpy(0.4, pitch, -0.9);
    const Eigen::Vector3d rpy = rpy_from_rotation(R);
    EXPECT_DOUBLE_EQ(rpy.x(), 0.0);
    EXPECT_LT((rotation_from_rpy(rpy.x(), rpy.y(), rpy.z()) - R).norm(), 1e-12);
  }
}

TEST(Units, ConvertBothWays) {
  EXPECT_DOUBLE_EQ(rad_from_deg(180.0), kHalfTurn);
  EXPECT_DOUBLE_EQ(deg_from_rad(kHalfTurn / 6), 30.0);
  EXPECT_DOUBLE_EQ(m_from_mm(250.0), 0.25);
  EXPECT_DOUBLE_EQ(mm_from_m(0.25), 250.0);
}

}  // namespace
}  // namespace cellmirror
