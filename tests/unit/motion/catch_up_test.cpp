// Times of moves that follow each other, and of moves that begin late.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "arms.hpp"
#include "ride.hpp"

namespace cellmirror::motion {
namespace {

using test_arms::gantry;
using test_arms::puma;
using test_arms::puma_posture;

constexpr double kVelocity = 0.8;
constexpr double kAcceleration = 3.2;  // a quarter of a second
constexpr double kNanoseconds = 1e-8;

class Times : public testing::TestWithParam<VelocityProfile> {
 protected:
  Times() {
    ride_.parameters.velocity_profile = GetParam();
    ride_.parameters.active_velocity.fill(kVelocity);
    ride_.parameters.active_acceleration.fill(kAcceleration);
    ride_.parameters.linear_velocity = kVelocity;
    ride_.parameters.linear_acceleration = kAcceleration;
  }
  static double duration(double way) {
    const double ramp = kVelocity * kVelocity / kAcceleration;
    return way >= ramp ? way / kVelocity + kVelocity / kAcceleration : 2 * std::sqrt(way / kAcceleration);
  }
  void stand(double seconds) {
    for (const double until = ride_.now() + seconds; ride_.now() < until - 0.5 * Ride::kTick;) ride_.tick();
  }
  // The greatest acceleration of the first axis before it stands.
  double run() {
    double hardest = 0;
    double velocity = 0;
    ride_.run([&] {
      if (ride_.state().moving) hardest = std::max(hardest, std::abs(ride_.qd()[0] - velocity) / Ride::kTick);
      velocity = ride_.qd()[0];
    });
    return hardest;
  }

  Ride ride_{gantry(), {}};
};

TEST_P(Times, OfMovesAndDelaysThatFollowEachOtherAddUpToTheNanosecond) {
  double expected = 0;
  const double ways[] = {0.1234567, 0.5, 0.03, 0.2345678, 0.0712345};
  double x = 0;
  JointValues from{};
  for (const double way : ways) {
    x += way;
    ASSERT_TRUE(ride_.sut().add(ride_.joints_to({x, 0, 0}, Start::queue)));
    ASSERT_TRUE(ride_.sut().add(ride_.pause(0.0123456)));
    expected += duration(way) + 0.0123456;
    from[0] = x;
  }
  for (const double way : ways) {
    x -= way;
    Pose to = ride_.X_BT();
    to.translation().x() = x;
    ASSERT_TRUE(ride_.sut().add(ride_.line_to(from, to, Start::queue).value()));
    from = ride_.end_of_plan;
    expected += duration(way);
  }
  const double seconds = ride_.run();
  EXPECT_NEAR(ride_.finished(), expected, 2 * kNanoseconds * 15);
  EXPECT_LE(seconds, expected + Ride::kTick);
}

TEST_P(Times, MoveThatBeginsLateEndsWhenItShould) {
  stand(0.1);
  for (const bool line : {false, true}) {
    const double begin = ride_.now();
    stand(0.020);
    Pose to = ride_.X_BT();
    to.translation().x() += 0.5;
    JointValues target = ride_.q();
    target[0] += 0.5;
    Move move = line ? ride_.line_to(ride_.q(), to, Start::queue).value() : ride_.joints_to(target, Start::queue);
    move.begin = Ride::time_of(begin);
    ASSERT_TRUE(ride_.sut().add(move));
    const double hardest = run();
    EXPECT_NEAR(ride_.finished(), begin + duration(0.5), kNanoseconds);
    const double steepest = GetParam() == VelocityProfile::sine ? std::numbers::pi / 2 : 1;
    EXPECT_NEAR(hardest, steepest * kAcceleration * 0.25 / 0.23, 0.03);
    EXPECT_NEAR(ride_.q()[0], target[0], 1e-9);
    stand(0.01);
  }
}

TEST_P(Times, WhatCannotBeMadeUpForWithinTheBoundsIsLostOrLeftToTheNextMove) {
  stand(1.0);
  // A second late: 50 ms are made up for.
  Move move = ride_.joints_to({0.5, 0, 0}, Start::queue);
  move.begin = Ride::time_of(0.001);
  double start = ride_.now();
  ASSERT_TRUE(ride_.sut().add(move));
  const double hardest = run();
  EXPECT_NEAR(ride_.finished(), start + duration(0.5) - kMostCatchUp, kNanoseconds);
  EXPECT_LT(hardest, 1.25 * kAcceleration * 1.6);
  stand(0.01);
  // A short way: 1.25 times the acceleration gains a tenth of its time; the rest is for the move behind it.
  start = ride_.now() - 0.03;
  move = ride_.joints_to({0.52, 0, 0}, Start::queue);
  move.begin = Ride::time_of(start);
  ASSERT_TRUE(ride_.sut().add(move));
  ASSERT_TRUE(ride_.sut().add(ride_.joints_to({1.02, 0, 0}, Start::queue)));
  while (ride_.state().finished < 2) ride_.tick();
  EXPECT_GE(ride_.now() - start, 0.03 + duration(0.02) * std::sqrt(0.8) - kNanoseconds);
  ride_.run();
  EXPECT_NEAR(ride_.finished(), start + duration(0.02) + duration(0.5), kNanoseconds);
}

TEST_P(Times, MoveThatFollowsOnMakesUpForTheTimeInWhichTheQueueWasEmpty) {
  ASSERT_TRUE(ride_.sut().add(ride_.joints_to({0.5, 0, 0}, Start::queue)));
  run();
  stand(0.012);
  Move move = ride_.joints_to({0, 0, 0}, Start::queue);
  move.follows_on = true;
  ASSERT_TRUE(ride_.sut().add(move));
  run();
  EXPECT_NEAR(ride_.finished(), 2 * duration(0.5), 2 * kNanoseconds);
  // Not where the robot stood longer: that was no haste.
  stand(1.0);
  const double start = ride_.now();
  move = ride_.joints_to({0.5, 0, 0}, Start::queue);
  move.follows_on = true;
  ASSERT_TRUE(ride_.sut().add(move));
  run();
  EXPECT_NEAR(ride_.finished(), start + duration(0.5), 2 * kNanoseconds);
}

TEST_P(Times, DelayThatBeginsLateEndsWhenItShould) {
  stand(0.1);
  Move pause = ride_.pause(0.2);
  pause.begin = Ride::time_of(0.07);
  ASSERT_TRUE(ride_.sut().add(pause));
  ride_.run();
  EXPECT_NEAR(ride_.finished(), 0.27, kNanoseconds);
}

TEST_P(Times, BeginningsInTheFutureOrOfMovesThatWaitHaveNoEffect) {
  Move first = ride_.joints_to({0.5, 0, 0}, Start::queue);
  first.begin = Ride::time_of(77);
  Move second = ride_.joints_to({0, 0, 0}, Start::queue);
  second.begin = Ride::time_of(0);
  ASSERT_TRUE(ride_.sut().add(first));
  ASSERT_TRUE(ride_.sut().add(second));
  ride_.run();
  EXPECT_NEAR(ride_.finished(), 2 * duration(0.5), kNanoseconds);
}

TEST_P(Times, MovesThatTakeNoTimeLoseNone) {
  for (int i = 0; i < 10; ++i) ASSERT_TRUE(ride_.sut().add(ride_.joints_to({}, Start::queue)));
  ASSERT_TRUE(ride_.sut().add(ride_.joints_to({0.5, 0, 0}, Start::queue)));
  ride_.run();
  EXPECT_NEAR(ride_.finished(), duration(0.5), kNanoseconds);
}

INSTANTIATE_TEST_SUITE_P(Shapes, Times, testing::Values(VelocityProfile::ramp, VelocityProfile::sine));

TEST(CatchUp, OfAnArmThatMovesAllItsAxesKeepsThemTogether) {
  for (const PtpMode mode : {PtpMode::synchronous, PtpMode::asynchronous}) {
    Ride ride(puma(), puma_posture());
    ride.parameters.ptp_mode = mode;
    ride.parameters.velocity_profile = VelocityProfile::ramp;
    for (int i = 0; i < 30; ++i) ride.tick();
    const JointValues target = {0.9, -1.2, 0.5, 0.1, 1.1, 0.4};
    Move move = ride.joints_to(target, Start::queue);
    const double nominal = duration_of(move, ride.q(), 6);
    move.begin = Ride::time_of(0.005);
    ASSERT_TRUE(ride.sut().add(move));
    ride.run();
    EXPECT_NEAR(ride.finished(), 0.005 + nominal, 1e-8);
    for (std::size_t i = 0; i < 6; ++i) EXPECT_NEAR(ride.q()[i], target[i], 1e-9);
  }
}

}  // namespace
}  // namespace cellmirror::motion
