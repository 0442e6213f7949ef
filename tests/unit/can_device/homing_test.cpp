// Each method of homing from every side, on an axis that follows at once.
#include "drivers/can/cia402/device/homing.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <optional>

namespace cellmirror::can {
namespace {

constexpr double kNegative = -1000;
constexpr double kPositive = 1000;
constexpr double kIndex = 64;  // index pulses at 0, 64, 128, ...

struct Found {
  Homing::State state = Homing::State::idle;
  double home = 0;
  double fastest_at_home = 0;
  double farthest = 0;  // from the middle
};

Found search(int number, double start, std::optional<JointInterval> home_switch, bool limits = true) {
  HomingInputs inputs;
  inputs.position = start;
  if (limits) inputs.limit_switches = JointInterval{kNegative, kPositive};
  inputs.home_switch = home_switch;
  inputs.index_distance = kIndex;
  Homing sut;
  sut.start(*homing_method(number), {start, 0, 0}, inputs, 200, 20, 4000);
  Found found;
  for (int i = 0; i < 1'000'000 && sut.state() == Homing::State::searching; ++i) {
    const MotionPoint at = sut.step(0.0005, inputs);
    inputs.position = at.position;
    found.fastest_at_home = std::abs(at.velocity);
    found.farthest = std::max(found.farthest, std::abs(at.position));
  }
  found.state = sut.state();
  found.home = sut.home();
  return found;
}

void expect_home(int number, double start, std::optional<JointInterval> home_switch, double home) {
  const Found found = search(number, start, home_switch);
  EXPECT_EQ(found.state, Homing::State::attained) << "method " << number << " from " << start;
  EXPECT_NEAR(found.home, home, 1e-6) << "method " << number << " from " << start;
  EXPECT_LE(found.fastest_at_home, 20 + 1e-6) << "method " << number << " from " << start;
  EXPECT_LE(found.farthest, 1010) << "method " << number << " from " << start;
}

TEST(Homing, MethodsOfLimitSwitches) {
  for (const double start : {-1003.0, -500.0, 3.0, 900.0}) {
    expect_home(17, start, {}, kNegative);
    expect_home(1, start, {}, -960);  // the first index pulse inwards
  }
  for (const double start : {-900.0, 500.0, 1003.0}) {
    expect_home(18, start, {}, kPositive);
    expect_home(2, start, {}, 960);
  }
}

// The home switch is active from 300 to the positive end.
TEST(Homing, MethodsOfAPositiveHomeSwitch) {
  const JointInterval home{300, 2000};
  for (const double start : {-500.0, 100.0, 299.0, 301.0, 800.0}) {
    expect_home(19, start, home, 300);
    expect_home(20, start, home, 300);
    expect_home(3, start, home, 256);
    expect_home(4, start, home, 320);
  }
}

TEST(Homing, MethodsOfANegativeHomeSwitch) {
  const JointInterval home{-2000, -300};
  for (const double start : {-800.0, -301.0, -299.0, 500.0}) {
    expect_home(21, start, home, -300);
    expect_home(22, start, home, -300);
    expect_home(5, start, home, -256);
    expect_home(6, start, home, -320);
  }
}

// The home switch is a cam from 300 to 400.
TEST(Homing, MethodsOfACam) {
  const JointInterval cam{300, 400};
  struct Expected {
    int number;
    double edge;
    double index;
  };
  for (const Expected& method : {Expected{7, 300, 256},
                                 {8, 300, 320},
                                 {9, 400, 384},
                                 {10, 400, 448},
                                 {11, 400, 448},
                                 {12, 400, 384},
                                 {13, 300, 320},
                                 {14, 300, 256}}) {
    for (const double start : {-700.0, 290.0, 350.0, 410.0, 900.0}) {
      expect_home(method.number, start, cam, method.index);
      expect_home(method.number + 16, start, cam, method.edge);
    }
  }
}

TEST(Homing, MethodsOfTheIndexAlone) {
  expect_home(33, 100, {}, 64);
  expect_home(34, 100, {}, 128);
  expect_home(33, 128, {}, 64);
}

TEST(Homing, MethodsOfTheCurrentPosition) {
  expect_home(35, 123, {}, 123);
  expect_home(37, -5, {}, -5);
}

TEST(Homing, KnowsNoOtherMethods) {
  for (const int number : {-1, 0, 15, 16, 31, 32, 36, 38, 127}) EXPECT_FALSE(homing_method(number)) << number;
}

TEST(Homing, FailsWithoutTheSwitchThatItNeeds) {
  EXPECT_EQ(search(7, 0, {}).state, Homing::State::failed);
  EXPECT_EQ(search(17, 0, {}, false).state, Homing::State::failed);
}

TEST(Homing, GivesUpWhereTheSwitchIsBeyondBothLimits) {
  const Found found = search(23, 0, JointInterval{5000, 6000});
  EXPECT_EQ(found.state, Homing::State::failed);
  EXPECT_LE(found.farthest, 1010);
}

}  // namespace
}  // namespace cellmirror::can
