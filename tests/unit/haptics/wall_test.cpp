// What the hand feels at walls, in closed form: through the whole channel.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "rig.hpp"

namespace cellmirror::haptics {
namespace {

using Eigen::Vector3d;
using test_rig::gantry;
using test_rig::model_of;
using test_rig::plain_settings;
using test_rig::plane;
using test_rig::Rig;

ContactConstraint floor_at_zero() { return plane(Vector3d::UnitZ(), 0, Vector3d::Zero()); }

// A gantry that these walls surround; the tip begins at the origin, from where the worker has looked.
struct WalledRig : Rig {
  WalledRig(const HapticSettings& settings, const std::vector<ContactConstraint>& walls) : Rig(gantry(settings)) {
    model = model_of(walls, Vector3d::Zero());
  }
};

TEST(Wall, PushesBackWithItsStiffnessTimesTheDepth) {
  for (const double stiffness : {200.0, 1000.0, 3000.0}) {
    HapticSettings settings = plain_settings();
    settings.stiffness = stiffness;
    WalledRig rig(settings, {floor_at_zero()});
    rig.go({0.02, 0, 0.01});
    EXPECT_EQ(rig.port.output.force_D.norm(), 0.0);
    for (const double depth : {0.001, 0.004, 0.01}) {
      rig.go({0.02, 0, -depth});
      EXPECT_NEAR(rig.port.output.force_D.z() / depth, stiffness, 1e-6 * stiffness) << depth;
      EXPECT_NEAR(rig.port.output.force_D.head<2>().norm(), 0, 1e-9);
      EXPECT_NEAR((rig.state().x_proxy - Vector3d(0.02, 0, 0)).norm(), 0, 1e-9);
      EXPECT_NEAR(rig.q[2], 0.0, 1e-8) << "the instrument does not enter";
    }
  }
}

TEST(Wall, OfAShaftThatMovesHalfAsMuchStopsTheTipInTheSamePlace) {
  ContactConstraint half = floor_at_zero();
  half.a *= 0.5;
  WalledRig rig(plain_settings(), {half});
  rig.go({0, 0, 0.01});
  rig.go({0, 0, -0.005});
  EXPECT_NEAR(rig.port.output.force_D.z(), 5.0, 1e-6);
  EXPECT_NEAR(rig.state().x_proxy.z(), 0, 1e-9);
}

TEST(Corner, OfTwoAndThreeWallsHoldsTheTipInIt) {
  const auto x = plane(Vector3d::UnitX(), 0, Vector3d::Zero());
  const auto y = plane(Vector3d::UnitY(), 0, Vector3d::Zero());
  WalledRig rig(plain_settings(), {floor_at_zero(), x, y});
  rig.go({0.01, 0.01, 0.01});
  rig.go({-0.003, 0.01, -0.004});
  EXPECT_NEAR((rig.port.output.force_D - Vector3d(3, 0, 4)).norm(), 0, 1e-6);
  EXPECT_EQ(rig.state().contacts, 2);
  rig.go({-0.003, -0.002, -0.004});
  EXPECT_NEAR((rig.port.output.force_D - Vector3d(3, 2, 4)).norm(), 0, 1e-6);
  EXPECT_EQ(rig.state().contacts, 3);
  EXPECT_NEAR(rig.state().x_proxy.norm(), 0, 1e-9);
}

TEST(Wall, ThatOverlapsAtTheStartMovesTheTipOut) {
  ContactConstraint overlapped = floor_at_zero();
  overlapped.gap = -0.002;
  WalledRig rig(plain_settings(), {overlapped});
  rig.tick({0, 0, 0});
  rig.tick({0, 0, 0});
  EXPECT_NEAR(rig.state().x_proxy.z(), 0.002, 1e-9);
}

TEST(Walls, ThatNoPointMeetsClampTheTip) {
  WalledRig rig(plain_settings(), {floor_at_zero()});
  rig.go({0, 0, 0.005});
  const auto ceiling = plane(-Vector3d::UnitZ(), 0.01, Vector3d::Zero());
  rig.model = model_of({plane(Vector3d::UnitZ(), 0.01, Vector3d::Zero()), ceiling}, Vector3d::Zero());
  rig.model.sequence = 1'000'000;
  rig.tick(Vector3d(0.002, 0, 0.005));
  EXPECT_NEAR((rig.state().x_proxy - Vector3d(0, 0, 0.005)).norm(), 0, 1e-9);
  EXPECT_NEAR((rig.port.output.force_D - Vector3d(-2, 0, 0)).norm(), 0, 1e-6);
}

TEST(Friction, HoldsUntilTheTangentialForceLeavesItsCone) {
  HapticSettings settings = plain_settings();
  settings.static_friction = 0.6;
  settings.dynamic_friction = 0.4;
  WalledRig rig(settings, {floor_at_zero()});
  rig.go({0, 0, 0.002});
  rig.go({0, 0, -0.005});
  const double normal = 5.0;
  double last = 0;
  double x = 0;
  while (rig.state().x_proxy.x() < 1e-9 && x < 0.01) {
    last = -rig.port.output.force_D.x();
    x += 1e-5;
    rig.tick({x, 0, -0.005});
  }
  EXPECT_NEAR(last, settings.static_friction * normal, 0.02) << "sticks up to the static angle";
  EXPECT_NEAR(-rig.port.output.force_D.x(), settings.dynamic_friction * normal, 1e-6)
      << "and slides at the dynamic one";
  rig.go({x + 0.004, 0, -0.005}, 0);
  EXPECT_NEAR(-rig.port.output.force_D.x(), settings.dynamic_friction * normal, 1e-6);
  EXPECT_NEAR(rig.port.output.force_D.z(), normal, 1e-6);
  EXPECT_NEAR(rig.state().x_proxy.z(), 0, 1e-9);
}

TEST(Friction, BeginsToStickAgainWhenTheHandTurnsBack) {
  HapticSettings settings = plain_settings();
  WalledRig rig(settings, {floor_at_zero()});
  rig.instrument.settings.static_friction = 0.6;
  rig.instrument.settings.dynamic_friction = 0.4;
  rig.go({0, 0, 0.002});
  rig.go({0, 0, -0.005});
  rig.go({0.02, 0, -0.005});
  const double slid_to = rig.state().x_proxy.x();
  EXPECT_NEAR(slid_to, 0.018, 1e-9);
  rig.go({0.0165, 0, -0.005});
  EXPECT_NEAR(rig.state().x_proxy.x(), slid_to, 1e-9);
  EXPECT_GT(rig.port.output.force_D.x(), 0) << "pulls the hand the other way now";
}

TEST(Friction, DoesNotDragTheTipThroughAnotherWall) {
  HapticSettings settings = plain_settings();
  settings.static_friction = 5;
  settings.dynamic_friction = 5;
  const Vector3d slope = Vector3d(-1, 0, 1).normalized();
  WalledRig rig(settings, {floor_at_zero(), plane(slope, 0, Vector3d::Zero())});
  rig.go({-0.005, 0, 0.005});
  rig.go({-0.005, 0, -0.004});
  rig.go({0.006, 0, -0.004});
  EXPECT_GE(rig.state().x_proxy.z(), -1e-9);
  EXPECT_GE(slope.dot(rig.state().x_proxy), -1e-9);
}

TEST(Force, IsToldInEveryFrame) {
  HapticSettings settings = plain_settings();
  settings.X_WD.linear() = Eigen::AngleAxisd(std::numbers::pi / 2, Vector3d::UnitX()).toRotationMatrix();
  settings.force_scale = 0.5;
  settings.workspace_scale = 2.0;
  WalledRig rig(settings, {floor_at_zero()});
  // The world's z is the device's -(-y): R_WD turns y into z.
  rig.go({0, 0.005, 0});
  rig.go({0, -0.001, 0});
  EXPECT_NEAR((rig.state().force_W - Vector3d(0, 0, 2)).norm(), 0, 1e-6);
  EXPECT_NEAR((rig.port.output.force_D - Vector3d(0, 1, 0)).norm(), 0, 1e-6);
  EXPECT_NEAR((rig.port.output.force_E - Vector3d(0, 0, 2)).norm(), 0, 1e-6);
  EXPECT_NEAR(rig.state().joint_torques[2], 2, 1e-6);
  EXPECT_NEAR(rig.port.output.joint_torques[2], 1, 1e-6);
}

TEST(Force, HasTheTorqueAboutTheToolAxisOfWhatTouchesBesideIt) {
  ContactConstraint side = plane(Vector3d::UnitX(), 0, Vector3d::Zero());
  side.point = Vector3d(0, 0.01, 0);
  WalledRig rig(plain_settings(), {side});
  rig.go({0.005, 0, 0});
  rig.go({-0.004, 0, 0});
  // 4 N along x at y = 10 mm turn by -0.04 Nm about z.
  EXPECT_NEAR(rig.state().axis_torque, -0.04, 1e-6);
  EXPECT_NEAR(rig.state().joint_torques[3], -0.04, 1e-6);
  EXPECT_NEAR(rig.port.output.torque_D.z(), -0.04, 1e-6);
}

TEST(Force, IsCutAtItsLimitAndSlewed) {
  HapticSettings settings = plain_settings();
  settings.max_force = 3;
  settings.max_slew = 500;
  WalledRig rig(settings, {floor_at_zero()});
  rig.go({0, 0, 0.0004});
  double last = 0;
  rig.go({0, 0, 0.0001});
  for (int i = 0; i < 40; ++i) {
    rig.tick({0, 0, -0.002 - 0.0002 * i});
    const double force = rig.port.output.force_D.norm();
    EXPECT_LE(force, 3 + 1e-12);
    EXPECT_LE(std::abs(force - last), 0.5 + 1e-12);
    last = force;
  }
  EXPECT_NEAR(last, 3, 1e-9);
  EXPECT_GT(rig.state().saturated, 5U);
  EXPECT_EQ(rig.port.output.max_force, 3);
}

TEST(Engagement, FadesTheForceIn) {
  HapticSettings settings = plain_settings();
  settings.engage_time = Nanoseconds{100'000'000};
  WalledRig rig(settings, {floor_at_zero()});
  rig.go({0, 0, 0.001}, 0);
  EXPECT_EQ(rig.state().phase, HapticPhase::engaging);
  rig.go({0, 0, -0.004}, 30);
  EXPECT_EQ(rig.state().phase, HapticPhase::engaging);
  EXPECT_GT(rig.port.output.force_D.z(), 0.5);
  EXPECT_LT(rig.port.output.force_D.z(), 3.5);
  rig.go({0, 0, -0.004}, 80);
  EXPECT_EQ(rig.state().phase, HapticPhase::active);
  EXPECT_NEAR(rig.port.output.force_D.z(), 4, 1e-6);
}

TEST(Engagement, InsideOfAWallIsFeltOnlyByPressingOn) {
  WalledRig rig(plain_settings(), {floor_at_zero()});
  rig.port.sample.p_DH = Vector3d(0, 0, -0.01);
  rig.go({0, 0, -0.01}, 400);
  EXPECT_NEAR(rig.port.output.force_D.norm(), 0, 1e-9);
  EXPECT_NEAR(rig.state().x_proxy.z(), 0, 1e-9);
  rig.go({0, 0, -0.012});
  EXPECT_NEAR(rig.port.output.force_D.z(), 2, 1e-6);
  rig.go({0, 0, -0.004});
  EXPECT_NEAR(rig.port.output.force_D.norm(), 0, 1e-9);
  rig.go({0, 0, 0.001});
  rig.go({0, 0, -0.004});
  EXPECT_NEAR(rig.port.output.force_D.z(), 4, 1e-6) << "once it has been out, the wall is where it is";
}

TEST(Engagement, BringsTheInstrumentToTheHandAlongFreeWays) {
  HapticSettings settings = plain_settings();
  settings.X_WD.translation() = Vector3d(0.2, 0, -0.1);  // far away, and behind the wall
  WalledRig rig(settings, {floor_at_zero()});
  double largest_step = 0;
  Vector3d last = Vector3d::Zero();
  for (int i = 0; i < 300; ++i) {
    rig.tick({0, 0, 0});
    largest_step = std::max(largest_step, (rig.state().x_proxy - last).norm());
    last = rig.state().x_proxy;
    EXPECT_GE(last.z(), -1e-9);
  }
  EXPECT_LE(largest_step, settings.max_speed * 1e-3 + 1e-9);
  EXPECT_NEAR((last - Vector3d(0.2, 0, 0)).norm(), 0, 1e-9);
  EXPECT_EQ(rig.port.output.force_D.norm(), 0.0);
}

TEST(Proxy, StaysWithinWhatTheModelHasSeen) {
  WalledRig rig(plain_settings(), {floor_at_zero()});
  rig.model.reach = 0.02;
  rig.go({0.015, 0, 0.001});
  EXPECT_NEAR(rig.state().x_proxy.x(), 0.015, 1e-9);
  rig.go({0.05, 0, 0.001});
  EXPECT_LE(rig.state().x_proxy.norm(), 0.02 + 1e-9);
  EXPECT_EQ(rig.port.output.force_D.norm(), 0.0) << "not knowing is not a wall";
  rig.model.x_ref = rig.state().x_proxy;
  rig.model.constraints[0].gap = rig.model.x_ref.z();
  rig.go({0.038, 0, 0.001});
  EXPECT_NEAR(rig.state().x_proxy.x(), 0.038, 1e-9);
}

TEST(Proxy, DoesNotComeNearerToWhatIsUncertain) {
  WalledRig rig(plain_settings(), {floor_at_zero()});
  rig.model.certain = false;
  rig.model.constraints[0].gap = 0.003;  // the tip stood 3 mm above it
  rig.go({0, 0, 0.001});
  rig.go({0, 0, -0.001});
  EXPECT_NEAR(rig.state().x_proxy.z(), 0, 1e-9);
  EXPECT_NEAR(rig.port.output.force_D.z(), 1, 1e-6);
}

TEST(Damping, ActsAgainstTheMotionAndNeverPullsIn) {
  HapticSettings settings = plain_settings();
  settings.damping = 20;
  WalledRig rig(settings, {floor_at_zero()});
  rig.go({0, 0, 0.001});
  for (int i = 0; i < 20; ++i) rig.tick({0, 0, -0.0002 * i});
  EXPECT_GT(rig.port.output.force_D.z(), 1000 * 0.0038 + 2) << "0.2 m/s inwards add up to 4 N";
  for (int i = 0; i < 15; ++i) {
    rig.tick({0, 0, -0.0038 + 0.0002 * i});
    EXPECT_GE(rig.port.output.force_D.z(), 0);
  }
}

}  // namespace
}  // namespace cellmirror::haptics
