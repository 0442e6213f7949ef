#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "arms.hpp"
#include "ride.hpp"
#include "rt_core/motion/arc.hpp"

namespace cellmirror::motion {
namespace {

using test_arms::gantry;
using test_arms::panda;
using test_arms::panda_posture;
using test_arms::puma;
using test_arms::puma_posture;

constexpr double kPi = std::numbers::pi;

// On the circle of that radius about `start` + (0, 0, radius), in an upright plane at 30 degrees to x;
// `angle` from the start on.
Eigen::Vector3d on_circle(const Eigen::Vector3d& start, double radius, double angle) {
  const Eigen::Vector3d along = Eigen::AngleAxisd(kPi / 6, Eigen::Vector3d::UnitZ()) * Eigen::Vector3d::UnitX();
  return start + radius * (std::sin(angle) * along + (1 - std::cos(angle)) * Eigen::Vector3d::UnitZ());
}

Pose at(const Pose& X, const Eigen::Vector3d& p, double turn = 0) {
  Pose out = X;
  out.translation() = p;
  out.linear() = Eigen::AngleAxisd(turn, Eigen::Vector3d::UnitZ()) * X.linear();
  return out;
}

TEST(Arc, GoesThroughItsThreePointsTheShortAndTheLongWay) {
  const Eigen::Vector3d start(1, 0, 0);
  const Eigen::Vector3d goal(0, 1, 0);
  const auto quarter = Arc::through(start, {std::sqrt(0.5), std::sqrt(0.5), 0}, goal);
  const auto rest = Arc::through(start, {-std::sqrt(0.5), -std::sqrt(0.5), 0}, goal);
  ASSERT_TRUE(quarter && rest);
  EXPECT_NEAR(quarter->radius(), 1, 1e-12);
  EXPECT_NEAR(quarter->angle, kPi / 2, 1e-12);
  EXPECT_NEAR((quarter->normal - Eigen::Vector3d(0, 0, 1)).norm(), 0, 1e-12);
  EXPECT_NEAR(rest->radius(), 1, 1e-12);
  EXPECT_NEAR(rest->angle, 3 * kPi / 2, 1e-12);
  EXPECT_NEAR((rest->normal - Eigen::Vector3d(0, 0, -1)).norm(), 0, 1e-12);
  for (const Arc& arc : {*quarter, *rest}) {
    EXPECT_NEAR((start + arc.displacement(1) - goal).norm(), 0, 1e-12);
    EXPECT_NEAR((start + arc.displacement(0) - start).norm(), 0, 1e-12);
    const Eigen::Vector3d step = arc.displacement(0.3 + 1e-6) - arc.displacement(0.3 - 1e-6);
    EXPECT_NEAR((step / 2e-6 - arc.velocity(0.3)).norm(), 0, 1e-8);
  }
}

TEST(Arc, PointsThatCoincideOrLieOnOneLineHaveNone) {
  const Eigen::Vector3d a(1, 2, 3);
  const Eigen::Vector3d b(1.5, 2, 3);
  EXPECT_FALSE(Arc::through(a, a, b));
  EXPECT_FALSE(Arc::through(a, b, a));
  EXPECT_FALSE(Arc::through(a, b, b));
  EXPECT_FALSE(Arc::through(a, 0.3 * a + 0.7 * b, b));
  EXPECT_FALSE(Arc::through(a, {std::nan(""), 0, 0}, b));
}

TEST(CircularMove, StaysOnTheArcTakesItsTimeAndEndsOnTheTarget) {
  for (const auto& [arm, posture] : {std::pair{puma(), puma_posture()}, {panda(), panda_posture()}}) {
    Ride ride(arm, posture);
    ride.parameters.linear_velocity = 0.2;
    const Pose from = ride.X_BT();
    constexpr double kRadius = 0.08;
    constexpr double kAngle = 2.0;
    const Eigen::Vector3d start = from.translation();
    const Eigen::Vector3d centre = start + Eigen::Vector3d(0, 0, kRadius);
    const Pose to = at(from, on_circle(start, kRadius, kAngle), 0.2);
    const auto move = ride.arc_to(ride.q(), on_circle(start, kRadius, 0.7), to);
    ASSERT_TRUE(move) << move.error().text();
    const double length = kRadius * kAngle;
    EXPECT_NEAR(ride.duration_of_plan, length / 0.2 + 0.2 / 2.0, 1e-9);
    ASSERT_TRUE(ride.sut().add(*move));
    double off = 0;
    double to_via = 1;
    double fastest = 0;
    double untrue = 0;
    Pose before = from;
    const double seconds = ride.run([&] {
      const Pose X = ride.X_BT();
      off = std::max(off, std::abs((X.translation() - centre).norm() - kRadius));
      to_via = std::min(to_via, (X.translation() - on_circle(start, kRadius, 0.7)).norm());
      fastest = std::max(fastest, (X.translation() - before.translation()).norm() / Ride::kTick);
      // The orientation turns in proportion to the way.
      const Eigen::Vector3d spoke = X.translation() - centre;
      const double share = std::acos(std::clamp(-spoke.z() / kRadius, -1.0, 1.0)) / kAngle;
      const double turned = Eigen::AngleAxisd(from.linear().transpose() * X.linear()).angle();
      untrue = std::max(untrue, std::abs(turned - 0.2 * share));
      before = X;
    });
    EXPECT_LT(off, 2e-6);
    EXPECT_LT(to_via, 0.2 * Ride::kTick);
    EXPECT_NEAR(fastest, 0.2, 1e-5);
    EXPECT_LT(untrue, 1e-4);
    EXPECT_NEAR(seconds, ride.duration_of_plan, Ride::kTick);
    EXPECT_NEAR(ride.finished(), ride.duration_of_plan, 1e-8);
    EXPECT_LT((ride.X_BT().translation() - to.translation()).norm(), 1e-9);
    EXPECT_LT((ride.X_BT().linear() - to.linear()).norm(), 1e-9);
    EXPECT_EQ(ride.state().outcome, Outcome::arrived);
  }
}

TEST(CircularMove, SmallArcIsNotFasterThanItsCentripetalAccelerationAllows) {
  Ride ride(gantry(), {0.1, 0.2, 0.3});
  ride.parameters.max_velocity.fill(5);
  const Eigen::Vector3d start = ride.X_BT().translation();
  constexpr double kRadius = 0.02;  // 0.5 m/s would be 12.5 m/s2
  const Pose to = at(ride.X_BT(), on_circle(start, kRadius, kPi));
  ASSERT_TRUE(ride.sut().add(ride.arc_to(ride.q(), on_circle(start, kRadius, 1), to).value()));
  const double speed = std::sqrt(2.0 * kRadius);
  EXPECT_NEAR(ride.duration_of_plan, kRadius * kPi / speed + speed / 2.0, 1e-9);
  double fastest = 0;
  Eigen::Vector3d before = start;
  ride.run([&] {
    fastest = std::max(fastest, (ride.X_BT().translation() - before).norm() / Ride::kTick);
    before = ride.X_BT().translation();
  });
  EXPECT_LT(fastest, speed * (1 + 1e-6));
}

TEST(CircularMove, StopBrakesOnTheArcWithinItsAcceleration) {
  for (const VelocityProfile profile : {VelocityProfile::ramp, VelocityProfile::sine}) {
    for (const double after : {0.05, 0.3, 0.62}) {
      Ride ride(puma(), puma_posture());
      ride.parameters.velocity_profile = profile;
      ride.parameters.linear_velocity = 0.25;
      constexpr double kRadius = 0.08;
      const Eigen::Vector3d start = ride.X_BT().translation();
      const Eigen::Vector3d centre = start + Eigen::Vector3d(0, 0, kRadius);
      const Pose to = at(ride.X_BT(), on_circle(start, kRadius, 2.0));
      ASSERT_TRUE(ride.sut().add(ride.arc_to(ride.q(), on_circle(start, kRadius, 1), to).value()));
      while (ride.now() < after) ride.tick();
      ride.sut().stop();
      double off = 0;
      const double seconds =
          ride.run([&] { off = std::max(off, std::abs((ride.X_BT().translation() - centre).norm() - kRadius)); });
      EXPECT_LT(off, 2e-6) << after;
      EXPECT_LE(seconds, 0.25 / 2.0 + 2 * Ride::kTick) << after;
      EXPECT_EQ(ride.state().outcome, Outcome::stopped);
    }
  }
}

TEST(CircularMove, FliesIntoALineAndOutOfOneWithoutAStop) {
  Ride ride(puma(), puma_posture());
  ride.parameters.velocity_profile = VelocityProfile::ramp;
  ride.parameters.linear_velocity = 0.25;
  ride.parameters.fly_type = FlyType::distance;
  ride.parameters.fly_parameter = 0.02;
  const Pose from = ride.X_BT();
  constexpr double kRadius = 0.1;
  const Pose first = at(from, from.translation() + Eigen::Vector3d(0, -0.1, 0));
  const Eigen::Vector3d corner = first.translation();
  const Eigen::Vector3d centre = corner + Eigen::Vector3d(0, 0, kRadius);
  const Pose second = at(from, on_circle(corner, kRadius, 1.5));
  const Pose third = at(from, second.translation() + Eigen::Vector3d(0, -0.1, 0));
  ASSERT_TRUE(ride.sut().add(ride.line_to(ride.q(), first, Start::queue).value()));
  ASSERT_TRUE(ride.sut().add(ride.arc_to(ride.end_of_plan, on_circle(corner, kRadius, 0.7), second).value()));
  ASSERT_TRUE(ride.sut().add(ride.line_to(ride.end_of_plan, third, Start::queue).value()));
  double slowest = 1;
  double off = 0;
  Eigen::Vector3d before = from.translation();
  ride.run([&] {
    const Eigen::Vector3d p = ride.X_BT().translation();
    if (ride.now() > 0.2 && ride.state().finished < 2) slowest = std::min(slowest, (p - before).norm() / Ride::kTick);
    // Between the corners it is on the arc alone.
    if (ride.state().finished == 1 && ride.state().running == 2)
      off = std::max(off, std::abs((p - centre).norm() - kRadius));
    before = p;
  });
  EXPECT_GT(slowest, 0.05);
  EXPECT_LT(off, 2e-6);
  EXPECT_LT((ride.X_BT().translation() - third.translation()).norm(), 1e-9);
  EXPECT_EQ(ride.state().finished, 3U);
}

TEST(CircularMove, TakesThePlaceOfALineAfterThatHasBraked) {
  Ride ride(puma(), puma_posture());
  const Pose from = ride.X_BT();
  ASSERT_TRUE(
      ride.sut().add(ride.line_to(ride.q(), at(from, from.translation() + Eigen::Vector3d(0, -0.2, 0))).value()));
  for (int i = 0; i < 200; ++i) ride.tick();
  Move arc = ride.arc_to(ride.q(), on_circle(ride.X_BT().translation(), 0.08, 0.5),
                         at(from, on_circle(ride.X_BT().translation(), 0.08, 1.0)), Start::supersede)
                 .value();
  ASSERT_TRUE(ride.sut().add(arc));
  double off = 0;
  while (ride.state().moving) {
    ride.tick();
    const Eigen::Vector3d p = ride.X_BT().translation();
    if (std::abs(ride.X_BT().translation().z() - from.translation().z()) < 1e-9)
      off = std::max(off, std::abs(p.x() - from.translation().x()));
  }
  EXPECT_LT(off, 1e-6);
  EXPECT_LT((ride.X_BT().translation() - arc.X_BG.translation()).norm(), 1e-9);
}

TEST(PlanCircularMove, RefusesWhatIsNoArcAndTellsHowFarItGoes) {
  Ride ride(puma(), puma_posture());
  const Pose X = ride.X_BT();
  const Eigen::Vector3d p = X.translation();
  const auto refused = [&](const Eigen::Vector3d& via, const Pose& to) {
    const auto move = ride.arc_to(ride.q(), via, to);
    return move ? std::string() : move.error().text();
  };
  const Pose to = at(X, p + Eigen::Vector3d(0, -0.2, 0));
  EXPECT_NE(refused(p + Eigen::Vector3d(0, -0.1, 0), to).find("all lie on one line"), std::string::npos);
  EXPECT_NE(refused(p + Eigen::Vector3d(0.1, 0, 0), X).find("two of them coincide"), std::string::npos);
  EXPECT_NE(refused({std::nan(""), 0, 0}, to).find("finite"), std::string::npos);
  const std::string far = refused(p + Eigen::Vector3d(2, -1, 0), at(X, p + Eigen::Vector3d(0, -2, 0)));
  EXPECT_NE(far.find("the arc is possible for"), std::string::npos) << far;
  ride.parameters.inverse_class = InverseClass::align_xy_axis;
  EXPECT_NE(refused(p + Eigen::Vector3d(0.1, -0.1, 0), to).find("rob_inverse_class"), std::string::npos);
}

}  // namespace
}  // namespace cellmirror::motion
