// The simulated hand against closed forms, and in virtual time against a wall.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "sim_devices/haptic/hand.hpp"
#include "sim_devices/haptic/haptic_device.hpp"

namespace cellmirror::sim {
namespace {

// x(t) of m x" + b x' + k x = 0 from x0 at rest, damping ratio below 1 (any textbook on vibrations).
double damped_oscillator(double m, double b, double k, double x0, double t) {
  const double decay = b / (2 * m);
  const double omega = std::sqrt(k / m - decay * decay);
  return x0 * std::exp(-decay * t) * (std::cos(omega * t) + decay / omega * std::sin(omega * t));
}

TEST(Oscillator, FollowsTheClosedFormOfTheDampedOscillator) {
  const Impedance impedance{0.25, 6, 300};
  OscillatorState sut{0.01, 0};
  const double dt = 250e-6;
  double worst = 0;
  for (int i = 1; i <= 8000; ++i) {
    sut = advance(sut, impedance, {}, 0, dt);
    worst = std::max(worst, std::abs(sut.x - damped_oscillator(0.25, 6, 300, 0.01, i * dt)));
  }
  EXPECT_LT(worst, 1e-10);
}

TEST(Oscillator, IsOfFourthOrder) {
  const Impedance impedance{0.25, 6, 300};
  const auto error = [&](int steps) {
    OscillatorState state{0.01, 0};
    for (int i = 0; i < steps; ++i) state = advance(state, impedance, {}, 0, 0.2 / steps);
    return std::abs(state.x - damped_oscillator(0.25, 6, 300, 0.01, 0.2));
  };
  EXPECT_NEAR(std::log2(error(20) / error(40)), 4, 0.4);
}

TEST(Oscillator, WithoutSpringAndDamperAForceGivesAParabola) {
  OscillatorState sut{0, 0};
  for (int i = 0; i < 1000; ++i) sut = advance(sut, {2, 0, 0}, {}, 4, 1e-3);
  EXPECT_NEAR(sut.x, 1.0, 1e-12);  // F/m t2/2
  EXPECT_NEAR(sut.v, 2.0, 1e-12);
}

TEST(Hand, StandsWhereSpringAndPushAreEqual) {
  const AxisLayout layout(6);
  Hand sut(layout, {}, {});
  Coordinates wish{};
  wish[2] = 0.01;
  Coordinates push{};
  push[2] = -1.5;
  for (int i = 0; i < 5000; ++i) sut.step(wish, {}, push, true, 1e-3);
  EXPECT_NEAR(sut.coordinates()[2], 0.01 - 1.5 / 300, 1e-9);
  EXPECT_NEAR(sut.work(), -1.5 * sut.coordinates()[2], 1e-12);
}

TEST(Hand, LetGoIsADeviceOfItsOwnMassAndFriction) {
  HandParameters parameters;
  parameters.released = {0.06, 0.0, 0};
  Hand sut(AxisLayout(6), parameters, {});
  Coordinates push{};
  push[0] = 0.6;
  for (int i = 0; i < 100; ++i) sut.step({}, {}, push, false, 1e-3);
  EXPECT_NEAR(sut.coordinates()[0], 0.5 * 10 * 0.01, 1e-12);
}

TEST(Hand, OfATrocarTurnsWithTheArmSquared) {
  HandParameters parameters;
  parameters.arm = 0.2;
  Hand sut(AxisLayout(4), parameters, {});
  Coordinates push{};
  push[0] = 0.12;  // Nm: 300 N/m at 0.2 m are 12 Nm/rad
  for (int i = 0; i < 5000; ++i) sut.step({}, {}, push, true, 1e-3);
  EXPECT_NEAR(sut.coordinates()[0], 0.01, 1e-9);
}

TEST(Hand, TremblesAsTheSeedSaysAndNoFurtherThanItsAmplitudeAllows) {
  HandParameters parameters;
  parameters.tremor = 1e-4;
  Hand sut(AxisLayout(6), parameters, {});
  Hand twin(AxisLayout(6), parameters, {});
  parameters.seed = 2;
  Hand other(AxisLayout(6), parameters, {});
  double largest = 0;
  for (int i = 0; i < 3000; ++i) {
    for (Hand* hand : {&sut, &twin, &other}) hand->step({}, {}, {}, true, 1e-3);
    largest = std::max(largest, std::abs(sut.coordinates()[0]));
    ASSERT_EQ(sut.coordinates(), twin.coordinates());
  }
  EXPECT_NE(sut.coordinates(), other.coordinates());
  EXPECT_GT(largest, 1e-6);
  EXPECT_LT(largest, 2e-4);
}

// A wall at x = 0: the push on a handle that is behind it.
class Wall {
 public:
  explicit Wall(const std::string& motion, double stiffness = 1000) : stiffness_(stiffness) {
    Diagnostics diagnostics;
    options_.motion = parse_motion(motion, "test", AxisLayout(6), diagnostics);
    EXPECT_TRUE(diagnostics.ok()) << diagnostics.text();
    options_.start[2] = 0.02;
    options_.length_resolution = 0;
  }
  void play(HapticDevice& device, int periods) {
    for (int i = 0; i < periods; ++i) {
      t_ += 1e-3;
      const HapticSample& sample = device.step(answer_, Timestamp{static_cast<std::int64_t>(t_ * 1e9)}, t_, 1e-3);
      answer_.force_D = {0, 0, std::max(0.0, -stiffness_ * sample.p_DH.z())};
      largest_ = std::max(largest_, answer_.force_D.z());
    }
  }
  [[nodiscard]] const HapticOptions& options() const { return options_; }
  [[nodiscard]] double force() const { return answer_.force_D.z(); }
  [[nodiscard]] double largest() const { return largest_; }

 private:
  double stiffness_;
  double t_ = 0;
  double largest_ = 0;
  HapticOptions options_;
  HapticOutput answer_;
};

TEST(Motion, TouchEndsWhereSomethingIsFeltAndPressGoesDeeper) {
  Wall wall("touch z -0.1 speed=0.02 at=0.2; hold 1s; press 0.01 2s");
  HapticDevice sut(wall.options());
  wall.play(sut, 1900);  // 1 s to the wall, then hold
  EXPECT_GT(wall.force(), 0.05);
  EXPECT_LT(wall.force(), 0.6);
  const double touched = wall.force();
  wall.play(sut, 1500);
  EXPECT_NEAR(wall.force() - touched, 0.01 / (1.0 / 300 + 1.0 / 1000), 0.05);  // two springs in a row
  EXPECT_FALSE(sut.done());
  wall.play(sut, 1500);
  EXPECT_TRUE(sut.done());
}

TEST(Motion, TouchWithNothingInTheWayEndsAtItsDistance) {
  Wall wall("touch z -0.01 speed=0.05; hold 1s");
  HapticDevice sut(wall.options());
  wall.play(sut, 2000);
  EXPECT_NEAR(sut.hand().coordinates()[2], 0.01, 1e-6);
}

TEST(Motion, DragMovesSidewaysUnderForceAndBackReturns) {
  Wall wall("touch z -0.1 speed=0.05; press 0.005 500ms; drag x 0.02 speed=0.05; hold 500ms; back speed=0.1; hold 1s");
  HapticDevice sut(wall.options());
  wall.play(sut, 2100);
  EXPECT_NEAR(sut.hand().coordinates()[0], 0.02, 1e-3);
  EXPECT_GT(wall.force(), 0.5);
  wall.play(sut, 3000);
  EXPECT_TRUE(sut.done());
  EXPECT_NEAR(sut.hand().coordinates()[0], 0, 1e-4);
  EXPECT_NEAR(sut.hand().coordinates()[2], 0.02, 1e-4);
  EXPECT_EQ(wall.force(), 0);
}

TEST(Motion, LettingGoIsPushedOutAndHoldsWhereItCameTo) {
  Wall wall("touch z -0.1 speed=0.05; press 0.01 500ms; letgo 300ms; hold 1s");
  HapticDevice sut(wall.options());
  wall.play(sut, 900);
  EXPECT_GT(wall.force(), 1);
  wall.play(sut, 1500);
  EXPECT_EQ(wall.force(), 0);
  EXPECT_GT(sut.hand().coordinates()[2], 0.01);
}

TEST(Motion, TapsAsOftenAsAsked) {
  Wall wall("tap z -0.03 times=3 period=400ms at=0.3; hold 500ms");
  HapticDevice sut(wall.options());
  int touches = 0;
  bool touching = false;
  for (int i = 0; i < 2000; ++i) {
    wall.play(sut, 1);
    const bool now = wall.force() > 0.1 || (touching && wall.force() > 0);
    touches += now && !touching ? 1 : 0;
    touching = now;
  }
  EXPECT_EQ(touches, 3);
  EXPECT_NEAR(sut.hand().coordinates()[2], 0.02, 1e-4);
}

TEST(Motion, CirclesAndSinesHaveTheirRadiusAndPeriod) {
  Wall wall("circle x y 0.01 2s period=2s");
  HapticDevice circle(wall.options());
  double farthest = 0;
  for (int i = 0; i < 1990; ++i) {
    wall.play(circle, 1);
    farthest = std::max(farthest, std::abs(circle.hand().coordinates()[1]));
  }
  EXPECT_NEAR(farthest, 0.01, 5e-4);
  EXPECT_NEAR(circle.hand().coordinates()[0], 0, 1e-3);
  Wall other("sine y 0.02 1s period=1s");
  HapticDevice sine(other.options());
  other.play(sine, 250);
  EXPECT_NEAR(sine.hand().coordinates()[1], 0.02, 3e-3);
}

TEST(Motion, ButtonsStayUntilTheyAreReleased) {
  Wall wall("button 2 on; hold 10ms; button 1 on; hold 10ms; button 2 off; hold 1s");
  HapticDevice sut(wall.options());
  wall.play(sut, 5);
  EXPECT_EQ(sut.step({}, {}, 0, 1e-3).buttons, 2U);
  wall.play(sut, 10);
  EXPECT_EQ(sut.step({}, {}, 0, 1e-3).buttons, 3U);
  wall.play(sut, 10);
  EXPECT_EQ(sut.step({}, {}, 0, 1e-3).buttons, 1U);
}

TEST(HapticDevice, MeasuresInStepsOfItsEncoders) {
  Wall wall("sine x 0.005 10s");
  HapticOptions options = wall.options();
  options.length_resolution = 1e-4;
  HapticDevice sut(options);
  for (int i = 0; i < 500; ++i) {
    wall.play(sut, 1);
    const double steps = sut.measured()[0] / 1e-4;
    ASSERT_NEAR(steps, std::round(steps), 1e-9);
    ASSERT_NEAR(sut.measured()[0], sut.hand().coordinates()[0], 0.51e-4);
  }
}

TEST(AxisLayout, APoseDeviceShowsItsRotationVector) {
  HapticSample sample;
  AxisLayout(7).show({1, 2, 3, 0, 0, 1.5707963267948966, 0.4}, sample);
  EXPECT_EQ(sample.axis_count, 7);
  EXPECT_LT((sample.p_DH - Eigen::Vector3d(1, 2, 3)).norm(), 1e-15);
  EXPECT_LT((sample.q_DH * Eigen::Vector3d::UnitX() - Eigen::Vector3d::UnitY()).norm(), 1e-12);
  EXPECT_EQ(sample.gripper, 0.4);
}

TEST(AxisLayout, ATrocarFeelsJointTorquesAndAHandleForces) {
  HapticOutput answer;
  answer.joint_count = 5;
  answer.joint_torques = {1, 2, 3, 4, 5};
  answer.force_D = {6, 7, 8};
  answer.torque_D = {9, 10, 11};
  answer.gripper_torque = 12;
  EXPECT_EQ(AxisLayout(4).efforts(answer), (Coordinates{1, 2, 3, 4}));
  EXPECT_EQ(AxisLayout(5).efforts(answer), (Coordinates{1, 2, 3, 4, 5}));
  EXPECT_EQ(AxisLayout(7).efforts(answer), (Coordinates{6, 7, 8, 9, 10, 11, 12}));
}

}  // namespace
}  // namespace cellmirror::sim
