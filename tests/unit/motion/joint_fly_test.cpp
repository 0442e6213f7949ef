// Fly points between PTP moves.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "arms.hpp"
#include "ride.hpp"

namespace cellmirror::motion {
namespace {

using test_arms::puma;
using test_arms::puma_posture;

struct Passage {
  double distance = 1;  // of the TCP from that of the first target when the second move began, m
  double angle = 1;     // rad
  double share = 0;     // greatest velocity of a joint then, of its cruise
  double nearest = 1;   // of the posture to the first target, rad
  double hardest = 0;   // acceleration of any joint, rad/s2
  double seconds = 0;
};

class JointFly : public testing::Test {
 protected:
  JointFly() {
    ride_.parameters.velocity_profile = VelocityProfile::ramp;
    ride_.parameters.ptp_mode = PtpMode::asynchronous;
  }

  Passage pass(FlyType type, double parameter, const JointValues& first, const JointValues& second) {
    Move one = ride_.joints_to(first, Start::queue);
    one.fly_type = type;
    one.fly_parameter = parameter;
    EXPECT_TRUE(ride_.sut().add(one));
    EXPECT_TRUE(ride_.sut().add(ride_.joints_to(second, Start::queue)));
    const Pose corner = kinematics::forward(ride_.chain(), std::span(first).first(6));
    Passage out;
    JointValues velocity{};
    Pose before = ride_.X_BT();
    out.seconds = ride_.run([&] {
      double away = 0;
      for (std::size_t i = 0; i < 6; ++i) {
        away = std::max(away, std::abs(ride_.q()[i] - first[i]));
        out.hardest = std::max(out.hardest, std::abs(ride_.qd()[i] - velocity[i]) / Ride::kTick);
      }
      if (ride_.state().running == 2 && out.distance == 1) {
        out.distance = (before.translation() - corner.translation()).norm();
        out.angle = Eigen::AngleAxisd(before.linear().transpose() * corner.linear()).angle();
        for (std::size_t i = 0; i < 6; ++i) out.share = std::max(out.share, std::abs(velocity[i]));
      }
      out.nearest = std::min(out.nearest, away);
      velocity = ride_.qd();
      before = ride_.X_BT();
    });
    for (std::size_t i = 0; i < 6; ++i) EXPECT_NEAR(ride_.q()[i], second[i], 1e-9);
    EXPECT_EQ(ride_.state().finished, 2U);
    EXPECT_EQ(ride_.state().outcome, Outcome::arrived);
    return out;
  }

  static JointValues moved(double first, double second) {
    JointValues q = puma_posture();
    q[0] += first;
    q[1] += second;
    return q;
  }

  Ride ride_{puma(), puma_posture()};
  // 1 rad/s and 4 rad/s2
  static constexpr double kOneMove = 0.8 / 1.0 + 0.25;
};

TEST_F(JointFly, WithoutAParameterTheRobotStopsAtTheTarget) {
  const Passage passage = pass(FlyType::distance, 0, moved(0.8, 0), moved(0.8, 0.8));
  EXPECT_LT(passage.nearest, 1e-9);
  EXPECT_NEAR(passage.seconds, 2 * kOneMove, 2 * Ride::kTick);
}

TEST_F(JointFly, ByDistanceTheNextMoveBeginsNearTheTarget) {
  const Passage passage = pass(FlyType::distance, 0.02, moved(0.8, 0), moved(0.8, 0.8));
  EXPECT_LT(passage.distance, 0.02);
  EXPECT_GT(passage.distance, 0.015);
  EXPECT_GT(passage.nearest, 0.0001);
  EXPECT_LT(passage.seconds, 2 * kOneMove - 0.05);
  EXPECT_LT(passage.hardest, 4.0 + 0.05);
}

TEST_F(JointFly, ByAngleTheNextMoveBeginsNearTheOrientationOfTheTarget) {
  const Passage passage = pass(FlyType::angle, 0.05, moved(0.8, 0), moved(0.8, 0.8));
  EXPECT_LT(passage.angle, 0.05);
  EXPECT_GT(passage.angle, 0.048);
}

TEST_F(JointFly, BySpeedTheNextMoveBeginsBelowTheFractionOfTheCruise) {
  const Passage passage = pass(FlyType::speed_fraction, 0.5, moved(0.8, 0), moved(0.8, 0.8));
  EXPECT_LT(passage.share, 0.5);
  EXPECT_GT(passage.share, 0.5 - 3 * 4.0 * Ride::kTick);
}

TEST_F(JointFly, AxisThatGoesOnKeepsItsSpeed) {
  // With the fraction 1 the next move begins where the braking begins: one long way with the closed form's time.
  const Passage passage = pass(FlyType::speed_fraction, 1, moved(0.8, 0), moved(1.6, 0));
  EXPECT_NEAR(passage.seconds, 1.6 / 1.0 + 0.25, 4 * Ride::kTick);
}

TEST_F(JointFly, WristThatTurnsOnTheSpotDoesNotFlyBeforeItBrakes) {
  // The last axis turns the tool about itself: the TCP is at its target all the time.
  JointValues first = puma_posture();
  first[5] += 0.8;
  JointValues second = first;
  second[0] += 0.8;
  const Passage passage = pass(FlyType::distance, 0.02, first, second);
  EXPECT_LT(passage.nearest, 0.5 * 1.0 / 4.0 + 0.01);
}

TEST_F(JointFly, NeverIntoALine) {
  Move one = ride_.joints_to(moved(0.3, 0), Start::queue);
  one.fly_type = FlyType::speed_fraction;
  one.fly_parameter = 1;
  Pose to = kinematics::forward(ride_.chain(), std::span(one.target).first(6));
  to.translation().z() += 0.1;
  ASSERT_TRUE(ride_.sut().add(one));
  ASSERT_TRUE(ride_.sut().add(ride_.line_to(moved(0.3, 0), to, Start::queue).value()));
  double nearest = 1;
  ride_.run([&] { nearest = std::min(nearest, std::abs(ride_.q()[0] - one.target[0])); });
  EXPECT_LT(nearest, 1e-9);
  EXPECT_EQ(ride_.state().outcome, Outcome::arrived);
}

TEST_F(JointFly, UnderAHoldTheNextMoveIsTakenUpAtThePaceOfTheFirst) {
  Move one = ride_.joints_to(moved(0.8, 0), Start::queue);
  one.fly_type = FlyType::speed_fraction;
  one.fly_parameter = 0.9;
  ASSERT_TRUE(ride_.sut().add(one));
  ASSERT_TRUE(ride_.sut().add(ride_.joints_to(moved(1.6, 0.4), Start::queue)));
  double hardest = 0;
  JointValues velocity{};
  ride_.sut().set_pace(0.4);
  ride_.run([&] {
    for (std::size_t i = 0; i < 6; ++i)
      hardest = std::max(hardest, std::abs(ride_.qd()[i] - velocity[i]) / Ride::kTick);
    velocity = ride_.qd();
  });
  EXPECT_LT(hardest, 4.0 + 0.05);
  EXPECT_NEAR(ride_.q()[0], moved(1.6, 0.4)[0], 1e-9);
}

}  // namespace
}  // namespace cellmirror::motion
