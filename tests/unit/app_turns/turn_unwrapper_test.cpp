#include "app/io/turn_unwrapper.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

namespace cellmirror::app {
namespace {

constexpr double kPi = std::numbers::pi;

struct Inlet final : JointSampleSink {
  bool push(const JointSample& sample) noexcept override {
    samples.push_back(sample);
    return true;
  }
  std::vector<JointSample> samples;
};

struct TurnUnwrapperTest : testing::Test {
  Inlet inlet;
  TurnUnwrapper sut{inlet, 0b01};  // the first of two joints is continuous
  std::uint64_t sequence = 0;

  double pushed(double first, double second = 0.0) {
    JointSample sample;
    sample.sequence = ++sequence;
    sample.present = 0b11;
    sample.position[0] = first;
    sample.position[1] = second;
    EXPECT_TRUE(sut.push(sample));
    EXPECT_EQ(inlet.samples.back().position[1], second) << "the other joint is unchanged";
    return inlet.samples.back().position[0];
  }
};

TEST_F(TurnUnwrapperTest, APositionThatWrapsIsContinuedInBothDirections) {
  for (const double direction : {1.0, -1.0}) {
    sut.restart();
    for (int i = 0; i <= 1000; ++i) {
      const double real = direction * 0.05 * i;
      EXPECT_NEAR(pushed(std::remainder(real, 2 * kPi)), real, 1e-9) << i;
    }
  }
}

TEST_F(TurnUnwrapperTest, APositionFromZeroToOneTurnIsContinued) {
  for (int i = 0; i <= 1000; ++i) {
    const double real = 0.05 * i;
    EXPECT_NEAR(pushed(std::fmod(real, 2 * kPi)), real, 1e-9) << i;
  }
}

TEST_F(TurnUnwrapperTest, ASourceThatCountsTurnsPassesUnchanged) {
  for (int i = 0; i <= 100; ++i) EXPECT_EQ(pushed(0.9 * i), 0.9 * i);
  EXPECT_EQ(pushed(500.0), 500.0) << "the source was silent for some turns";
}

TEST_F(TurnUnwrapperTest, ARestartedSourceIsNotContinued) {
  static_cast<void>(pushed(3.1));
  EXPECT_NEAR(pushed(-3.1), 2 * kPi - 3.1, 1e-9);
  sequence = JointSample::kBeginsAnew - 1;
  EXPECT_EQ(pushed(-3.0), -3.0);
}

TEST_F(TurnUnwrapperTest, ARestartCountsAlsoInASampleWithoutTheJoint) {
  pushed(3.0);
  pushed(-3.0);
  JointSample other;
  other.sequence = JointSample::kBeginsAnew;
  other.present = 0b10;
  EXPECT_TRUE(sut.push(other));
  EXPECT_EQ(pushed(-3.0), -3.0);
}

TEST_F(TurnUnwrapperTest, NonFiniteAndAbsentPositionsChangeNothing) {
  static_cast<void>(pushed(3.1));
  EXPECT_TRUE(std::isnan(pushed(std::numeric_limits<double>::quiet_NaN())));
  JointSample other;
  other.present = 0b10;
  EXPECT_TRUE(sut.push(other));
  EXPECT_NEAR(pushed(-3.1), 2 * kPi - 3.1, 1e-9);
}

}  // namespace
}  // namespace cellmirror::app
