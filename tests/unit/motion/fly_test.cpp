// Manual, rob_cart_fly_radius.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "arms.hpp"
#include "ride.hpp"

namespace cellmirror::motion {
namespace {

using test_arms::puma;
using test_arms::puma_posture;

struct Corner {
  double speed = 0;     // of the path when the second move began
  double distance = 0;  // to the corner, m
  double angle = 0;     // to the orientation at the corner, rad
  double slowest = 1;   // m/s, from the beginning of the second move until the first has ended
  double fastest = 0;   // m/s, at any time
  double seconds = 0;
};

class FlyPoint : public testing::Test {
 protected:
  FlyPoint() { ride_.parameters.velocity_profile = VelocityProfile::ramp; }

  // 200 mm along -y, turning by `turn` rad about z, then 200 mm along x.
  Corner go_round(FlyType type, double parameter, double turn = 0) {
    ride_.parameters.fly_type = type;
    ride_.parameters.fly_parameter = parameter;
    Pose first = ride_.X_BT();
    first.translation().y() -= 0.2;
    first.linear() = Eigen::AngleAxisd(turn, Eigen::Vector3d::UnitZ()) * first.linear();
    Pose second = first;
    second.translation().x() += 0.2;
    auto one = ride_.line_to(ride_.q(), first, Start::queue);
    auto two = ride_.line_to(ride_.end_of_plan, second, Start::queue);
    EXPECT_TRUE(one && two);
    EXPECT_TRUE(ride_.sut().add(*one));
    EXPECT_TRUE(ride_.sut().add(*two));
    Corner corner;
    Pose before = ride_.X_BT();
    bool turned = false;
    corner.seconds = ride_.run([&] {
      const Pose now = ride_.X_BT();
      const double speed = (now.translation() - before.translation()).norm() / Ride::kTick;
      corner.fastest = std::max(corner.fastest, speed);
      if (!turned && ride_.state().running == 2) {
        turned = true;
        corner.speed = speed;
        corner.distance = (before.translation() - first.translation()).norm();
        corner.angle = Eigen::AngleAxisd(before.linear().transpose() * first.linear()).angle();
      }
      if (turned && ride_.state().finished == 0) corner.slowest = std::min(corner.slowest, speed);
      before = now;
    });
    EXPECT_LT((ride_.X_BT().translation() - second.translation()).norm(), 1e-9);
    EXPECT_EQ(ride_.state().finished, 2U);
    EXPECT_EQ(ride_.state().outcome, Outcome::arrived);
    return corner;
  }

  Ride ride_{puma(), puma_posture()};
};

TEST_F(FlyPoint, WithoutAParameterTheRobotStopsOnTheCorner) {
  const Corner corner = go_round(FlyType::distance, 0);
  EXPECT_LT(corner.distance, 2e-6);
  EXPECT_NEAR(corner.seconds, 2 * (0.2 / 0.5 + 0.25), 0.005);
}

class FlyPointByDistance : public FlyPoint, public testing::WithParamInterface<double> {};

TEST_P(FlyPointByDistance, TheNextMoveBeginsWithinTheDistance) {
  const double radius = GetParam();
  const Corner corner = go_round(FlyType::distance, radius);
  EXPECT_LT(corner.distance, radius + 1e-6);
  EXPECT_GT(corner.distance, radius - 0.5 * Ride::kTick - 1e-6);  // one tick at full speed
  EXPECT_GT(corner.slowest, 0.05);
}

INSTANTIATE_TEST_SUITE_P(Radii, FlyPointByDistance, testing::Values(0.005, 0.02, 0.04));

TEST_F(FlyPoint, BySpeedTheNextMoveBeginsWhenTheSpeedHasDroppedBelowTheFraction) {
  const Corner corner = go_round(FlyType::speed_fraction, 0.6);
  EXPECT_LT(corner.speed, 0.6 * 0.5 + 1e-6);
  EXPECT_GT(corner.speed, 0.6 * 0.5 - 3 * 2.0 * Ride::kTick);
  EXPECT_NEAR(corner.distance, 0.3 * 0.3 / (2 * 2.0), 1e-3);
}

TEST_F(FlyPoint, ByAngleTheNextMoveBeginsWithinTheAngle) {
  const Corner corner = go_round(FlyType::angle, 0.05, 0.4);
  EXPECT_LT(corner.angle, 0.05);
  EXPECT_GT(corner.angle, 0.05 - 1.0 * Ride::kTick - 1e-6);
}

TEST_F(FlyPoint, MoveWithoutRotationHasNoFlyPointByAngle) { EXPECT_LT(go_round(FlyType::angle, 0.05).distance, 2e-6); }

TEST_F(FlyPoint, TwoMovesTogetherAreNotFasterThanEitherMayBe) {
  // The whole first move is within the radius: both run side by side.
  const Corner corner = go_round(FlyType::distance, 0.5);
  EXPECT_LE(corner.fastest, 0.5 * (1 + 1e-5));
}

TEST_F(FlyPoint, TwoTurnsTogetherAreNotFasterThanEitherMayBe) {
  ride_.parameters.fly_type = FlyType::angle;
  ride_.parameters.fly_parameter = 3.0;  // all of the first: both run side by side
  Pose to = ride_.X_BT();
  for (int i = 0; i < 2; ++i) {
    to.linear() = Eigen::AngleAxisd(0.4, Eigen::Vector3d::UnitZ()) * to.linear();
    const auto move = ride_.line_to(i == 0 ? ride_.q() : ride_.end_of_plan, to, Start::queue);
    ASSERT_TRUE(move);
    ASSERT_TRUE(ride_.sut().add(*move));
  }
  Pose before = ride_.X_BT();
  double fastest = 0;
  ride_.run([&] {
    const Eigen::AngleAxisd turned(Eigen::Matrix3d(ride_.X_BT().linear() * before.linear().transpose()));
    fastest = std::max(fastest, turned.angle() / Ride::kTick);
    before = ride_.X_BT();
  });
  EXPECT_LE(fastest, 1.0 * (1 + 1e-4));
  EXPECT_GT(fastest, 0.9) << "they do run side by side";
  EXPECT_EQ(ride_.state().outcome, Outcome::arrived);
}

TEST_F(FlyPoint, RampsThatOverlapExactlyKeepTheSpeedOnAStraightLine) {
  // Begins where the braking begins: the one slows down as the other speeds up.
  ride_.parameters.fly_type = FlyType::speed_fraction;
  ride_.parameters.fly_parameter = 1.0;
  Pose to = ride_.X_BT();
  for (int i = 0; i < 2; ++i) {
    to.translation().y() -= 0.2;
    ASSERT_TRUE(ride_.sut().add(*ride_.line_to(i == 0 ? ride_.q() : ride_.end_of_plan, to, Start::queue)));
  }
  Pose before = ride_.X_BT();
  double slowest = 1;
  const double seconds = ride_.run([&] {
    const double speed = (ride_.X_BT().translation() - before.translation()).norm() / Ride::kTick;
    if (ride_.now() > 0.26 && ride_.now() < 0.75) slowest = std::min(slowest, speed);
    before = ride_.X_BT();
  });
  EXPECT_GT(slowest, 0.5 - 0.005);
  EXPECT_NEAR(seconds, 0.4 / 0.5 + 0.25, 0.005);
}

TEST_F(FlyPoint, StopInTheCornerEndsBothMoves) {
  ride_.parameters.fly_parameter = 0.04;
  Pose first = ride_.X_BT();
  first.translation().y() -= 0.2;
  Pose second = first;
  second.translation().x() += 0.2;
  ASSERT_TRUE(ride_.sut().add(*ride_.line_to(ride_.q(), first, Start::queue)));
  ASSERT_TRUE(ride_.sut().add(*ride_.line_to(ride_.end_of_plan, second, Start::queue)));
  while (ride_.state().running < 2) ride_.tick();
  for (int i = 0; i < 30; ++i) ride_.tick();
  ASSERT_EQ(ride_.state().finished, 0U);
  ride_.sut().stop();
  EXPECT_LT(ride_.run(), 0.26);
  EXPECT_EQ(ride_.state().finished, 2U);
  EXPECT_EQ(ride_.state().finished_from, 1U);
  EXPECT_EQ(ride_.state().outcome, Outcome::stopped);
}

TEST_F(FlyPoint, NeverBetweenALineAndAJointMove) {
  ride_.parameters.fly_parameter = 0.05;
  Pose first = ride_.X_BT();
  first.translation().y() -= 0.2;
  ASSERT_TRUE(ride_.sut().add(*ride_.line_to(ride_.q(), first, Start::queue)));
  ASSERT_TRUE(ride_.sut().add(ride_.joints_to(puma_posture(), Start::queue)));
  double nearest = 1;
  ride_.run([&] { nearest = std::min(nearest, (ride_.X_BT().translation() - first.translation()).norm()); });
  EXPECT_LT(nearest, 1e-9);
}

}  // namespace
}  // namespace cellmirror::motion
