#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <numbers>
#include <random>

#include "arms.hpp"
#include "ride.hpp"

namespace cellmirror::motion {
namespace {

using test_arms::gantry;
using test_arms::panda;
using test_arms::panda_posture;
using test_arms::puma;
using test_arms::puma_posture;

Pose moved_by(Pose X, const Eigen::Vector3d& p, double angle = 0, const Eigen::Vector3d& axis = {0, 0, 1}) {
  X.translation() += p;
  X.linear() = Eigen::AngleAxisd(angle, axis.normalized()) * X.linear();
  return X;
}

double distance_from_line(const Pose& X, const Pose& from, const Pose& to) {
  const Eigen::Vector3d along = (to.translation() - from.translation()).normalized();
  const Eigen::Vector3d off = X.translation() - from.translation();
  return (off - off.dot(along) * along).norm();
}

double angle_between(const Pose& a, const Pose& b) {
  return Eigen::AngleAxisd(a.linear().transpose() * b.linear()).angle();
}

TEST(LinearMove, StaysOnTheLineTakesItsTimeAndEndsOnTheTarget) {
  for (const auto& [arm, posture] : {std::pair{puma(), puma_posture()}, {panda(), panda_posture()}}) {
    Ride ride(arm, posture);
    const Pose from = ride.X_BT();
    const Pose to = moved_by(from, {0.05, -0.2, 0.1}, 0.3, {1, 1, 0});
    const auto move = ride.line_to(ride.q(), to);
    ASSERT_TRUE(move) << move.error().text();
    ASSERT_TRUE(ride.sut().add(*move));
    double off = 0;
    double fastest = 0;
    Pose before = from;
    const double seconds = ride.run([&] {
      const Pose X = ride.X_BT();
      off = std::max(off, distance_from_line(X, from, to));
      fastest = std::max(fastest, (X.translation() - before.translation()).norm() / Ride::kTick);
      before = X;
    });
    const double length = (to.translation() - from.translation()).norm();
    EXPECT_NEAR(ride.duration_of_plan, std::max(length / 0.5 + 0.25, 0.3 / 1.0 + 0.25), 1e-9);
    EXPECT_NEAR(seconds, ride.duration_of_plan, 0.003);
    EXPECT_LT(off, 1e-6);
    EXPECT_LE(fastest, 0.5 * (1 + 1e-5));
    EXPECT_LT((ride.X_BT().translation() - to.translation()).norm(), 1e-9);
    EXPECT_LT(angle_between(ride.X_BT(), to), 1e-9);
    EXPECT_EQ(ride.state().outcome, Outcome::arrived);
    EXPECT_EQ(ride.qd()[0], 0.0);
  }
}

TEST(LinearMove, OrientationTurnsAboutOneAxisInProportion) {
  Ride ride(puma(), puma_posture());
  const Pose from = ride.X_BT();
  const Eigen::Vector3d axis = Eigen::Vector3d(0.2, 1, -0.4).normalized();
  const Pose to = moved_by(from, {0.0, -0.1, 0.0}, 0.5, axis);
  ASSERT_TRUE(ride.sut().add(*ride.line_to(ride.q(), to)));
  ride.run([&] {
    const double share = (ride.X_BT().translation() - from.translation()).norm() / 0.1;
    const Eigen::AngleAxisd turned(ride.X_BT().linear() * from.linear().transpose());
    EXPECT_NEAR(turned.angle(), share * 0.5, 1e-5);
    if (turned.angle() > 0.01) {
      EXPECT_GT(turned.axis().dot(axis), 1 - 1e-6);
    }
  });
}

TEST(LinearMove, TheSlowerOfTranslationAndRotationDecides) {
  Ride ride(puma(), puma_posture());
  const Pose to = moved_by(ride.X_BT(), {0.0, -0.05, 0.0}, 0.6);
  ASSERT_TRUE(ride.sut().add(*ride.line_to(ride.q(), to)));
  EXPECT_NEAR(ride.duration_of_plan, 0.6 / 1.0 + 0.25, 1e-9);
  EXPECT_NEAR(ride.run(), 0.85, 0.003);
}

TEST(LinearMove, ScalesWithTheFactorsOfTheController) {
  Ride ride(puma(), puma_posture());
  ride.parameters.velocity_scale = 0.2;
  ride.parameters.acceleration_scale = 0.5;
  const auto move = ride.line_to(ride.q(), moved_by(ride.X_BT(), {0, -0.2, 0}));
  EXPECT_DOUBLE_EQ(move->linear_velocity, 0.1);
  EXPECT_DOUBLE_EQ(move->linear_acceleration, 1.0);
  EXPECT_DOUBLE_EQ(move->rotational_velocity, 0.2);
  EXPECT_DOUBLE_EQ(move->rotational_acceleration, 2.0);
  EXPECT_NEAR(ride.duration_of_plan, 2.1, 1e-9);
}

TEST(LinearMove, PathSlowsDownWhereAJointWouldBeTooFast) {
  Ride ride(puma(), puma_posture());
  ride.parameters.max_velocity.fill(0.2);
  const Pose from = ride.X_BT();
  const Pose to = moved_by(from, {0.05, -0.3, 0.1});
  ASSERT_TRUE(ride.sut().add(*ride.line_to(ride.q(), to)));
  double off = 0;
  const double seconds = ride.run([&] { off = std::max(off, distance_from_line(ride.X_BT(), from, to)); });
  EXPECT_GT(seconds, 1.5 * ride.duration_of_plan);
  EXPECT_LT(off, 1e-6);
  EXPECT_EQ(ride.state().outcome, Outcome::arrived);
}

TEST(LinearMove, StopBrakesOnTheLineWithinItsAcceleration) {
  for (const double when : {0.1, 0.2, 0.35, 0.55, 0.63, 0.68}) {
    Ride ride(puma(), puma_posture());
    const Pose from = ride.X_BT();
    const Pose to = moved_by(from, {0.0, -0.22, 0.0});
    ASSERT_TRUE(ride.sut().add(*ride.line_to(ride.q(), to)));
    while (ride.now() < when) ride.tick();
    const Pose asked = ride.X_BT();
    ride.sut().stop();
    double off = 0;
    const double seconds = ride.run([&] { off = std::max(off, distance_from_line(ride.X_BT(), from, to)); });
    EXPECT_LT(off, 1e-6);
    EXPECT_LE(seconds, 0.25 + 0.003);
    EXPECT_LE((ride.X_BT().translation() - asked.translation()).norm(), 0.5 * 0.5 / 4 + 1e-3);
    EXPECT_LE((ride.X_BT().translation() - from.translation()).norm(), 0.22 + 1e-9);
    EXPECT_EQ(ride.state().outcome, Outcome::stopped);
    EXPECT_EQ(ride.state().finished, 1U);
  }
}

TEST(LinearMove, NewLineStartsWithoutAStopAndEndsOnItsOwnTarget) {
  Ride ride(puma(), puma_posture());
  const Pose from = ride.X_BT();
  ASSERT_TRUE(ride.sut().add(*ride.line_to(ride.q(), moved_by(from, {0.0, -0.25, 0.0}))));
  while (ride.now() < 0.4) ride.tick();
  const Pose to = moved_by(from, {0.15, -0.1, 0.1}, 0.4, {0, 1, 0});
  auto second = ride.line_to(ride.q(), to);
  ASSERT_TRUE(second);
  ASSERT_TRUE(ride.sut().add(*second));
  Eigen::Vector3d before = ride.X_BT().translation();
  double slowest = 1;
  double fastest = 0;
  const double begin = ride.now();
  ride.run([&] {
    const Eigen::Vector3d now = ride.X_BT().translation();
    const double speed = (now - before).norm() / Ride::kTick;
    if (ride.now() < begin + 0.2) slowest = std::min(slowest, speed);
    fastest = std::max(fastest, speed);
    before = now;
  });
  EXPECT_GT(slowest, 0.15);
  EXPECT_LE(fastest, 0.5 * (1 + 1e-5));
  EXPECT_LT((ride.X_BT().translation() - to.translation()).norm(), 1e-9);
  EXPECT_LT(angle_between(ride.X_BT(), to), 1e-9);
  EXPECT_EQ(ride.state().finished, 2U);
  EXPECT_EQ(ride.state().outcome, Outcome::arrived);
}

TEST(LinearMove, CommandsThatFollowEachOtherQuicklyDoNotHoldItUp) {
  Ride ride(panda(), panda_posture());
  const Pose from = ride.X_BT();
  const Pose to = moved_by(from, {0.0, -0.3, 0.0});
  for (int i = 0; i < 700; ++i) {
    const auto move = ride.line_to(ride.q(), to);
    ASSERT_TRUE(move) << i << move.error().text();
    ASSERT_TRUE(ride.sut().add(*move));
    ride.tick();
  }
  EXPECT_GT((ride.X_BT().translation() - from.translation()).norm(), 0.2);
  ride.run();
  EXPECT_LT((ride.X_BT().translation() - to.translation()).norm(), 1e-9);
}

TEST(LinearMove, OtherKindsOfMovesWaitUntilItHasBrakedOnItsLine) {
  Ride ride(puma(), puma_posture());
  const Pose from = ride.X_BT();
  const Pose to = moved_by(from, {0.0, -0.25, 0.0});
  ASSERT_TRUE(ride.sut().add(*ride.line_to(ride.q(), to)));
  while (ride.now() < 0.4) ride.tick();
  JointValues target = ride.q();
  target[5] += 0.5;
  ASSERT_TRUE(ride.sut().add(ride.joints_to(target)));
  double off = 0;
  while (ride.now() < 0.4 + 0.25) {
    ride.tick();
    off = std::max(off, distance_from_line(ride.X_BT(), from, to));
  }
  EXPECT_LT(off, 1e-6);
  ride.run();
  for (std::size_t i = 0; i < 6; ++i) EXPECT_NEAR(ride.q()[i], target[i], 1e-12);
  EXPECT_EQ(ride.state().finished, 2U);
  EXPECT_EQ(ride.state().outcome, Outcome::arrived);
}

TEST(LinearMove, NewMoveForAnotherToolLeavesTheOldChainAtOnce) {
  Ride ride(puma(), puma_posture());
  auto old_chain = std::make_unique<kinematics::Chain>(puma());
  ride.sut().set_chain(old_chain.get());
  const Move line = *ride.line_to(ride.q(), moved_by(ride.X_BT(), {0.0, -0.25, 0.0}));
  ASSERT_TRUE(ride.sut().add(line));
  while (ride.now() < 0.4) ride.tick();
  ride.sut().set_chain(&ride.chain());
  const Pose to = moved_by(ride.X_BT(), {0.0, 0.1, 0.0});
  ASSERT_TRUE(ride.sut().add(*ride.line_to(ride.q(), to)));
  const JointValues speed = ride.qd();
  ride.tick();
  EXPECT_EQ(ride.state().finished, 1U);
  for (std::size_t i = 0; i < ride.joints(); ++i) {
    EXPECT_EQ(ride.sut().fastest()[i], std::max(line.max_velocity[i], std::abs(speed[i])))
        << "it brakes as fast as the line allowed it to be, and as it was";
  }
  old_chain.reset();  // what its owner may do now: a sanitizer sees whether it is still read
  ride.run();
  EXPECT_LT((ride.X_BT().translation() - to.translation()).norm(), 1e-9);
  EXPECT_EQ(ride.state().outcome, Outcome::arrived);
}

TEST(LinearMove, StopAfterAChangeOfTheToolBrakesOnTheLineAllTheSame) {
  Ride ride(puma(), puma_posture());
  const Pose from = ride.X_BT();
  const Pose to = moved_by(from, {0.0, -0.25, 0.0});
  ASSERT_TRUE(ride.sut().add(*ride.line_to(ride.q(), to)));
  while (ride.now() < 0.4) ride.tick();
  const kinematics::Chain other_tool = puma();
  ride.sut().set_chain(&other_tool);
  ride.sut().stop();
  double off = 0;
  ride.run([&] { off = std::max(off, distance_from_line(ride.X_BT(), from, to)); });
  EXPECT_LT(off, 1e-6);
  EXPECT_EQ(ride.state().outcome, Outcome::stopped);
}

TEST(LinearMove, MovesThatWaitKeepTheChainForWhichTheyWereAdded) {
  Ride ride(puma(), puma_posture());
  const Pose tool_before = ride.X_BT();
  ASSERT_TRUE(ride.sut().add(*ride.line_to(ride.q(), moved_by(tool_before, {0.0, -0.1, 0.0}), Start::queue)));
  ASSERT_TRUE(ride.sut().add(*ride.line_to(ride.end_of_plan, moved_by(tool_before, {0.0, -0.2, 0.0}), Start::queue)));
  const kinematics::Chain longer = ride.chain().with_tip(moved_by(ride.chain().X_LT(), {0, 0, 0.1}));
  ride.sut().set_chain(&longer);
  ride.run();
  EXPECT_NEAR(ride.X_BT().translation().y(), tool_before.translation().y() - 0.2, 1e-9);
}

TEST(LinearMove, LineOutOfReachIsRefusedByThePlannerAndBlockedByTheTick) {
  Ride ride(puma(), puma_posture());
  const Pose to = moved_by(ride.X_BT(), {0.0, 0.0, -3.0});
  const auto refused = ride.line_to(ride.q(), to);
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().text(), testing::HasSubstr("of 3000.0 mm"));
  Move move = *ride.line_to(ride.q(), ride.X_BT());
  move.X_BG = to;
  ASSERT_TRUE(ride.sut().add(move));
  ASSERT_TRUE(ride.sut().add(ride.pause(1.0)));
  JointValues before{};
  double hardest = 0;
  ride.run([&] {
    for (std::size_t i = 0; i < 6; ++i) {
      if (before[0] != 0) hardest = std::max(hardest, std::abs(ride.qd()[i] - before[i]) / Ride::kTick);
    }
    before = ride.qd();
  });
  EXPECT_EQ(ride.state().outcome, Outcome::blocked);
  EXPECT_EQ(ride.state().finished, 2U);
  EXPECT_EQ(ride.state().finished_from, 1U);
  EXPECT_EQ(ride.qd()[1], 0.0);
}

// From random postures, many of them near singular ones, where joints have to turn fast.
TEST(LinearMove, WhatThePlannerAcceptsArrivesOnItsLine) {
  std::mt19937_64 random(11);
  const auto uniform = [&](double low, double high) { return std::uniform_real_distribution(low, high)(random); };
  int accepted = 0;
  for (int round = 0; round < 400; ++round) {
    const kinematics::Chain arm = round % 2 == 0 ? puma() : panda();
    JointValues q{};
    for (std::size_t i = 0; i < arm.variable_count(); ++i) q[i] = uniform(arm.lower()[i], arm.upper()[i]);
    Ride ride(arm, q);
    const Pose from = ride.X_BT();
    const Pose to = moved_by(from, {uniform(-0.3, 0.3), uniform(-0.3, 0.3), uniform(-0.3, 0.3)}, uniform(-1, 1),
                             {uniform(-1, 1), uniform(-1, 1), 1.0});
    const auto move = ride.line_to(q, to);
    if (!move) continue;
    ++accepted;
    ASSERT_TRUE(ride.sut().add(*move));
    double off = 0;
    ride.run([&] { off = std::max(off, distance_from_line(ride.X_BT(), from, to)); });
    EXPECT_EQ(ride.state().outcome, Outcome::arrived) << "round " << round;
    EXPECT_LT(off, 1e-5) << "round " << round;
    EXPECT_LT((ride.X_BT().translation() - to.translation()).norm(), 1e-9) << "round " << round;
  }
  EXPECT_GT(accepted, 100);
  RecordProperty("accepted", accepted);
}

TEST(LinearMove, PartialTasksMeetWhatTheyNameAndLeaveTheRestFree) {
  Ride ride(puma(), puma_posture());
  ride.parameters.inverse_class = InverseClass::align_pos;
  const Pose from = ride.X_BT();
  const Pose to = moved_by(from, {0.05, -0.2, 0.1}, 1.5);
  ASSERT_TRUE(ride.sut().add(*ride.line_to(ride.q(), to)));
  EXPECT_NEAR(ride.duration_of_plan, (to.translation() - from.translation()).norm() / 0.5 + 0.25, 1e-9);
  double off = 0;
  ride.run([&] { off = std::max(off, distance_from_line(ride.X_BT(), from, to)); });
  EXPECT_LT(off, 1e-6);
  EXPECT_LT((ride.X_BT().translation() - to.translation()).norm(), 1e-9);
}

TEST(LinearMove, SlowJointsMoveInStepsOfTheirMinimumVelocity) {
  Ride ride(gantry(), {});
  ride.parameters.inverse_class = InverseClass::align_pos;
  ride.parameters.min_velocity = {0.0085, 0.0085, 0.0085};
  const Pose to = moved_by(ride.X_BT(), {0.3, 0.003, 0.0});
  ASSERT_TRUE(ride.sut().add(*ride.line_to(ride.q(), to)));
  int stood = 0;
  int moved = 0;
  ride.run([&] {
    for (std::size_t i = 0; i < 3; ++i) {
      const double speed = std::abs(ride.qd()[i]);
      EXPECT_TRUE(speed == 0.0 || speed >= 0.0085 * (1 - 1e-9)) << speed;
    }
    ride.qd()[1] == 0.0 ? ++stood : ++moved;
    EXPECT_LT(std::abs(ride.q()[1] - 0.01 * ride.q()[0]), 2 * 0.0085 * Ride::kTick);
  });
  EXPECT_GT(stood, 100);
  EXPECT_GT(moved, 100);
  EXPECT_NEAR(ride.q()[1], 0.003, 1e-9);
}

}  // namespace
}  // namespace cellmirror::motion
