// Hold and resume: the pace of the time on the path.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "arms.hpp"
#include "ride.hpp"

namespace cellmirror::motion {
namespace {

using test_arms::gantry;
using test_arms::puma;
using test_arms::puma_posture;

// From -1, 0.2, 0 to 1, -0.3, 0.5 with 0.8 m/s and 2 m/s2 on the first axis.
class HeldMove : public testing::TestWithParam<VelocityProfile> {
 protected:
  HeldMove() {
    ride_.parameters.velocity_profile = GetParam();
    ride_.parameters.active_velocity.fill(0.8);
    ride_.parameters.active_acceleration.fill(2.0);
    // The same without a hold: the way of the joints.
    Ride free(gantry(), kFrom);
    free.parameters = ride_.parameters;
    EXPECT_TRUE(free.sut().add(free.joints_to(kTo, Start::queue)));
    free.run([&] { way_.push_back(free.q()); });
    move_ = ride_.joints_to(kTo, Start::queue);
    EXPECT_TRUE(ride_.sut().add(move_));
  }

  // Follows the acceleration of the first axis and the distance from the way of the joints without a hold.
  void watch() {
    const double velocity = ride_.qd()[0];
    hardest_ = std::max(hardest_, std::abs(velocity - velocity_) / Ride::kTick);
    velocity_ = velocity;
    const auto next = std::ranges::lower_bound(way_, ride_.q()[0], {}, [](const JointValues& q) { return q[0]; });
    if (next == way_.begin() || next == way_.end()) return;
    const JointValues& before = *std::prev(next);
    const double share = (ride_.q()[0] - before[0]) / std::max((*next)[0] - before[0], 1e-12);
    for (std::size_t i = 1; i < 3; ++i)
      off_ = std::max(off_, std::abs(ride_.q()[i] - before[i] - share * ((*next)[i] - before[i])));
  }
  void go_on(double seconds) {
    for (const double until = ride_.now() + seconds; ride_.now() < until - 0.5 * Ride::kTick;) {
      ride_.tick();
      watch();
    }
  }
  [[nodiscard]] double hardest_allowed() const {
    // Within one tick the path's own speed changes as well: a few percent where it is slow.
    return 1.1 * 2.0 * (GetParam() == VelocityProfile::sine ? std::numbers::pi / 2 : 1.0);
  }

  static constexpr JointValues kFrom = {-1, 0.2, 0};
  static constexpr JointValues kTo = {1, -0.3, 0.5};
  Ride ride_{gantry(), kFrom};
  Move move_;
  double velocity_ = 0;
  double hardest_ = 0;
  double off_ = 0;
  std::vector<JointValues> way_;
};

TEST_P(HeldMove, BrakesOnItsWayWithinItsAccelerationAndArrivesAfterItWasResumed) {
  for (const double after : {0.1, 0.3, 1.0, 2.3, 2.7}) {
    SCOPED_TRACE(after);
    go_on(after - ride_.now() > 0 ? 0.05 : 0.01);
    ride_.sut().set_pace(0);
    go_on(0.5);
    EXPECT_EQ(ride_.state().pace, 0);
    EXPECT_TRUE(ride_.state().moving);
    const JointValues held = ride_.q();
    go_on(0.05);
    EXPECT_EQ(ride_.q(), held);
    EXPECT_EQ(ride_.qd()[0], 0);
    ride_.sut().set_pace(1);
    go_on(0.4);
  }
  ride_.run([&] { watch(); });
  for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(ride_.q()[i], kTo[i], 1e-12);
  EXPECT_LT(hardest_, hardest_allowed());
  EXPECT_LT(off_, 1e-6);  // between two ticks of the other
  EXPECT_EQ(ride_.state().outcome, Outcome::arrived);
  EXPECT_EQ(ride_.state().pace, 1);
}

TEST_P(HeldMove, TakesTheTimeOfTheBrakingOutOfTheCruise) {
  go_on(1.0);
  ride_.sut().set_pace(0);
  const double from = ride_.q()[0];
  const double start = ride_.now();
  while (ride_.state().pace > 0) go_on(Ride::kTick);
  EXPECT_NEAR(ride_.now() - start, 0.8 / 2.0, 2 * Ride::kTick);
  EXPECT_NEAR(ride_.q()[0] - from, 0.5 * 0.8 * 0.8 / 2.0, 1e-3);
  ride_.sut().set_pace(1);
  ride_.run([&] { watch(); });
  // Braking and speeding up again lose half of their time each.
  EXPECT_NEAR(ride_.finished(), 2.0 / 0.8 + 0.4 + 0.4, 3 * Ride::kTick);
}

TEST_P(HeldMove, ComesToItsEndWhereItBrakesAlready) {
  ASSERT_TRUE(ride_.sut().add(ride_.joints_to(kFrom, Start::queue)));
  go_on(2.0 / 0.8 + 0.01);  // it brakes from 2.5 s on
  ride_.sut().set_pace(0);
  go_on(1.0);
  EXPECT_NEAR(ride_.q()[0], kTo[0], GetParam() == VelocityProfile::ramp ? 1e-9 : 0.1);
  EXPECT_EQ(ride_.state().pace, 0);
  EXPECT_TRUE(ride_.state().moving);
  ride_.sut().set_pace(1);
  ride_.run([&] { watch(); });
  EXPECT_NEAR(ride_.q()[0], kFrom[0], 1e-9);
  EXPECT_LT(hardest_, hardest_allowed());
}

TEST_P(HeldMove, StopEndsTheHold) {
  go_on(1.0);
  ride_.sut().set_pace(0);
  go_on(0.2);
  ride_.sut().stop();
  go_on(0.5);
  EXPECT_FALSE(ride_.state().moving);
  EXPECT_EQ(ride_.state().outcome, Outcome::stopped);
  EXPECT_EQ(ride_.state().pace, 1);
  EXPECT_LT(hardest_, hardest_allowed());
  ASSERT_TRUE(ride_.sut().add(ride_.joints_to(kTo, Start::queue)));
  ride_.run();
  EXPECT_NEAR(ride_.q()[0], kTo[0], 1e-9);
}

TEST_P(HeldMove, StopOfARobotThatIsHeldEndsItsMovesAtOnce) {
  go_on(1.0);
  ride_.sut().set_pace(0);
  go_on(0.6);
  ride_.sut().stop();
  go_on(2 * Ride::kTick);
  EXPECT_FALSE(ride_.state().moving);
  EXPECT_EQ(ride_.state().finished, 1U);
}

TEST_P(HeldMove, MoveThatTakesItsPlaceEndsTheHold) {
  go_on(1.0);
  ride_.sut().set_pace(0);
  go_on(0.2);
  ASSERT_TRUE(ride_.sut().add(ride_.joints_to(kFrom)));
  ride_.run([&] {
    const double velocity = ride_.qd()[0];
    hardest_ = std::max(hardest_, std::abs(velocity - velocity_) / Ride::kTick);
    velocity_ = velocity;
  });
  EXPECT_NEAR(ride_.q()[0], kFrom[0], 1e-9);
  EXPECT_LT(hardest_, hardest_allowed());
  EXPECT_EQ(ride_.state().pace, 1);
}

TEST_P(HeldMove, HalfThePaceTakesTwiceTheTime) {
  ride_.sut().set_pace(0.5);
  ride_.run([&] { watch(); });
  EXPECT_NEAR(ride_.finished(), 2 * (2.0 / 0.8 + 0.4), 2 * Ride::kTick);
  EXPECT_LT(hardest_, hardest_allowed());
}

INSTANTIATE_TEST_SUITE_P(Shapes, HeldMove, testing::Values(VelocityProfile::ramp, VelocityProfile::sine));

TEST(Hold, KeepsALineAndAnArcOnTheirWays) {
  for (const bool arc : {false, true}) {
    Ride ride(puma(), puma_posture());
    ride.parameters.linear_velocity = 0.25;
    const Pose from = ride.X_BT();
    const Eigen::Vector3d centre = from.translation() + Eigen::Vector3d(0, -0.1, 0);
    Pose to = from;
    to.translation() += Eigen::Vector3d(0, -0.2, 0);
    const auto move =
        arc ? ride.arc_to(ride.q(), centre + Eigen::Vector3d(0, 0, 0.1), to) : ride.line_to(ride.q(), to, Start::queue);
    ASSERT_TRUE(move) << move.error().text();
    ASSERT_TRUE(ride.sut().add(*move));
    double off = 0;
    double hardest = 0;
    double speed = 0;
    Eigen::Vector3d before = from.translation();
    const auto watch = [&] {
      const Eigen::Vector3d p = ride.X_BT().translation();
      off = std::max(off, arc ? std::abs((p - centre).norm() - 0.1)
                              : (p - from.translation()).cross(Eigen::Vector3d::UnitY()).norm());
      const double now = (p - before).norm() / Ride::kTick;
      hardest = std::max(hardest, std::abs(now - speed) / Ride::kTick);
      speed = now;
      before = p;
    };
    const auto go_on = [&](double seconds) {
      for (int i = 0; i < std::lround(seconds / Ride::kTick); ++i) {
        ride.tick();
        watch();
      }
    };
    for (int i = 0; i < 4; ++i) {
      go_on(0.15);
      ride.sut().set_pace(0);
      go_on(0.3);
      EXPECT_EQ(ride.state().pace, 0);
      EXPECT_EQ(speed, 0);
      ride.sut().set_pace(1);
    }
    ride.run(watch);
    EXPECT_LT(off, 2e-6);
    EXPECT_LT(hardest, 2.0 * std::numbers::pi / 2 + 0.1);
    EXPECT_LT((ride.X_BT().translation() - to.translation()).norm(), 1e-9);
    EXPECT_EQ(ride.state().outcome, Outcome::arrived);
  }
}

TEST(Hold, StopOutOfAPaceOnALineGoesOnFromTheRealVelocity) {
  Ride ride(puma(), puma_posture());
  ride.parameters.velocity_profile = VelocityProfile::ramp;
  Pose to = ride.X_BT();
  to.translation().y() -= 0.3;
  ASSERT_TRUE(ride.sut().add(ride.line_to(ride.q(), to).value()));
  Eigen::Vector3d before = ride.X_BT().translation();
  double speed = 0;
  double hardest = 0;
  const auto watch = [&] {
    const double now = (ride.X_BT().translation() - before).norm() / Ride::kTick;
    before = ride.X_BT().translation();
    hardest = std::max(hardest, std::abs(now - speed) / Ride::kTick);
    speed = now;
  };
  for (int i = 0; i < 500; ++i) {
    if (i == 350) ride.sut().set_pace(0);
    ride.tick();
    watch();
  }
  ride.sut().stop();
  ride.run(watch);
  EXPECT_LT(hardest, 2.0 + 0.05);
  EXPECT_EQ(ride.state().pace, 1);
}

TEST(Hold, DelayStandsStillAndWhatWaitsDoesNotBegin) {
  Ride ride(gantry(), {});
  ASSERT_TRUE(ride.sut().add(ride.pause(0.5)));
  ASSERT_TRUE(ride.sut().add(ride.joints_to({0.1, 0.1, 0.1}, Start::queue)));
  for (int i = 0; i < 200; ++i) ride.tick();
  ride.sut().set_pace(0);
  for (int i = 0; i < 1000; ++i) ride.tick();
  EXPECT_EQ(ride.state().finished, 0U);
  EXPECT_EQ(ride.state().pace, 0);
  ride.sut().set_pace(1);
  for (int i = 0; i < 305; ++i) ride.tick();
  EXPECT_EQ(ride.state().finished, 1U);
  ride.sut().set_pace(0);
  for (int i = 0; i < 1000; ++i) ride.tick();
  const JointValues held = ride.q();
  EXPECT_LT(held[0], 0.01);
  ride.sut().set_pace(1);
  ride.run();
  EXPECT_NEAR(ride.q()[0], 0.1, 1e-12);
}

TEST(Hold, RobotThatStandsBeginsNothing) {
  Ride ride(gantry(), {});
  ride.sut().set_pace(0);
  ride.tick();
  EXPECT_FALSE(ride.state().moving);
  ASSERT_TRUE(ride.sut().add(ride.joints_to({0.1, 0.1, 0.1}, Start::queue)));
  for (int i = 0; i < 100; ++i) ride.tick();
  EXPECT_TRUE(ride.state().moving);
  EXPECT_EQ(ride.q()[0], 0);
  EXPECT_EQ(ride.state().finished, 0U);
  ride.sut().set_pace(std::nan(""));
  ride.tick();
  EXPECT_EQ(ride.state().pace, 0);
  ride.sut().set_pace(7);
  ride.run();
  EXPECT_NEAR(ride.q()[0], 0.1, 1e-12);
  EXPECT_EQ(ride.state().pace, 1);
}

TEST(HoldBehind, RobotStandsAtTheEndOfTheMoveAlsoWhereItHasAFlyPoint) {
  for (const bool line : {false, true}) {
    Ride ride(gantry(), {});
    ride.parameters.fly_type = FlyType::speed_fraction;
    ride.parameters.fly_parameter = 0.9;
    JointValues from{};
    for (int i = 1; i <= 3; ++i) {
      Pose X = ride.X_BT();
      X.translation().x() = 0.2 * i;
      Move move = line ? ride.line_to(from, X, Start::queue).value() : ride.joints_to({0.2 * i, 0, 0}, Start::queue);
      from[0] = 0.2 * i;
      move.fly_type = FlyType::speed_fraction;
      move.fly_parameter = 0.9;
      ASSERT_TRUE(ride.sut().add(move));
    }
    ride.sut().hold_behind(1);
    for (int i = 0; i < 2000; ++i) ride.tick();
    EXPECT_NEAR(ride.q()[0], 0.2, 1e-9) << line;
    EXPECT_TRUE(ride.state().moving);
    ride.sut().hold_behind(2);
    ride.sut().stop();
    ride.tick();
    EXPECT_FALSE(ride.state().moving);
    // The stop has ended the hold.
    ASSERT_TRUE(ride.sut().add(ride.joints_to({1.0, 0, 0}, Start::queue)));
    ride.run();
    EXPECT_NEAR(ride.q()[0], 1.0, 1e-9);
  }
}

TEST(HoldBehind, GoesOnMoveByMove) {
  Ride ride(gantry(), {});
  for (int i = 1; i <= 3; ++i) ASSERT_TRUE(ride.sut().add(ride.joints_to({0.1 * i, 0, 0}, Start::queue)));
  for (std::uint32_t id = 1; id <= 3; ++id) {
    ride.sut().hold_behind(id);
    for (int i = 0; i < 1500; ++i) ride.tick();
    EXPECT_EQ(ride.state().finished, id);
    EXPECT_NEAR(ride.q()[0], 0.1 * id, 1e-12);
  }
  EXPECT_FALSE(ride.state().moving);
}

}  // namespace
}  // namespace cellmirror::motion
