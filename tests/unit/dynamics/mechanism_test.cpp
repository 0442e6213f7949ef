#include "rt_core/dynamics/mechanism.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <random>

#include "tests/unit/dynamics/mechanisms.hpp"

namespace cellmirror::dynamics {
namespace {

using Eigen::Vector3d;

TEST(Inertia, ofTwoHalvesIsThatOfTheWhole) {
  // A rod of 1 m and 2 kg along x, out of two halves: m l2 / 12.
  const auto rod = [](double mass, double length, double middle) {
    const double moment = mass * length * length / 12;
    return Inertia{mass, {middle, 0, 0}, Vector3d(0, moment, moment).asDiagonal()};
  };
  const Inertia sut = joined(rod(1.0, 0.5, 0.25), rod(1.0, 0.5, 0.75));
  const Inertia whole = rod(2.0, 1.0, 0.5);
  EXPECT_DOUBLE_EQ(sut.mass, 2.0);
  EXPECT_TRUE(sut.p_C.isApprox(whole.p_C));
  EXPECT_TRUE(sut.I_C.isApprox(whole.I_C));
}

TEST(Inertia, movesWithItsBody) {
  Pose X_AB = Pose::Identity();
  X_AB.linear() = Eigen::AngleAxisd(std::numbers::pi / 2, Vector3d::UnitZ()).toRotationMatrix();
  X_AB.translation() = Vector3d(1, 2, 3);
  const Inertia sut = moved({4.0, {1, 0, 0}, Vector3d(1, 2, 3).asDiagonal()}, X_AB);
  EXPECT_TRUE(sut.p_C.isApprox(Vector3d(1, 3, 3)));
  EXPECT_TRUE(sut.I_C.isApprox(Eigen::Matrix3d(Vector3d(2, 1, 3).asDiagonal())));
}

// Only the moment about its axis is published of the first body of the Manutec r3.
TEST(Inertia, mayBeMomentsWithoutMass) {
  const Inertia sut = joined({0, Vector3d::Zero(), Vector3d(0, 0, 1.16).asDiagonal()}, {});
  EXPECT_EQ(sut.I_C(2, 2), 1.16);
  EXPECT_TRUE(check(sut));
  EXPECT_FALSE(is_empty(sut));
  EXPECT_TRUE(is_empty({}));
}

TEST(Inertia, thatNoBodyHasIsRefused) {
  const auto moments = [](const Eigen::Matrix3d& I) { return check({1.0, Vector3d::Zero(), I}); };
  EXPECT_FALSE(check({-1.0, Vector3d::Zero(), Eigen::Matrix3d::Zero()}));
  EXPECT_FALSE(check({std::nan(""), Vector3d::Zero(), Eigen::Matrix3d::Zero()}));
  EXPECT_FALSE(check({1.0, Vector3d(0, INFINITY, 0), Eigen::Matrix3d::Zero()}));
  EXPECT_FALSE(moments(Vector3d(1, 1, -0.1).asDiagonal()));
  Eigen::Matrix3d skew = Eigen::Matrix3d::Identity();
  skew(0, 1) = 0.3;
  EXPECT_FALSE(moments(skew));
  // Each moment is positive, but that about the axis (1, -1, 0) is not.
  Eigen::Matrix3d twisted = Eigen::Matrix3d::Identity();
  twisted(0, 1) = twisted(1, 0) = 1.5;
  EXPECT_FALSE(moments(twisted));
}

TEST(Mechanism, refusesWhatIsNone) {
  const auto refused = [](const Link& link, const Drive& drive = {}, int tip = 0) {
    const auto sut = Mechanism::make(std::vector{drive}, std::vector{link}, tip, Pose::Identity());
    return sut ? std::string() : sut.error().text();
  };
  EXPECT_EQ(refused({}), "");
  Link link;
  link.parent = 0;  // itself
  EXPECT_NE(refused(link).find("link 1"), std::string::npos);
  link = {};
  link.variable = 1;
  EXPECT_NE(refused(link), "");
  link = {};
  link.axis = Vector3d::Zero();
  EXPECT_NE(refused(link), "");
  link = {};
  link.X_PJ.translation().x() = std::nan("");
  EXPECT_NE(refused(link), "");
  link = {};
  link.multiplier = std::numeric_limits<double>::infinity();
  EXPECT_NE(refused(link), "");
  link = {};
  link.inertia.mass = -1;
  EXPECT_NE(refused(link), "");
  EXPECT_NE(refused({}, {0, -1, 0, 0, 0}).find("joint 1"), std::string::npos);
  EXPECT_NE(refused({}, {0, 0, std::nan(""), 0, 0}), "");
  EXPECT_NE(refused({}, {}, 1), "");
  EXPECT_FALSE(Mechanism::make(std::vector<Drive>(kMaxJointsPerRobot + 1), {}, -1, Pose::Identity()));
  EXPECT_FALSE(Mechanism::make(std::vector<Drive>(1), std::vector<Link>(kMaxLinks + 1), -1, Pose::Identity()));
  EXPECT_FALSE(made({Link{}}).with_payload(point_mass(-1, Vector3d::Zero())));
}

}  // namespace
}  // namespace cellmirror::dynamics
