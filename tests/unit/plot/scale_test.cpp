#include "app/plot/scale.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace cellmirror::plot {
namespace {

using testing::ElementsAre;

std::vector<std::string> labels(const Scale& scale) {
  std::vector<std::string> out;
  for (const Tick& tick : scale.ticks()) {
    if (!tick.label.empty()) out.push_back(tick.label);
  }
  return out;
}

TEST(RoundStep, IsOneTwoOrFiveTimesAPowerOfTen) {
  EXPECT_DOUBLE_EQ(round_step(10, 10), 1);
  EXPECT_DOUBLE_EQ(round_step(11, 10), 2);
  EXPECT_DOUBLE_EQ(round_step(0.3, 10), 0.05);
  EXPECT_DOUBLE_EQ(round_step(60, 10), 10);
}

TEST(Scale, EndsAtRoundNumbersAroundTheData) {
  const std::vector<double> values = {0.3, 9.2};
  const Scale sut({}, values, 5);
  EXPECT_DOUBLE_EQ(sut.low(), 0);
  EXPECT_DOUBLE_EQ(sut.high(), 10);
  EXPECT_THAT(labels(sut), ElementsAre("0", "2", "4", "6", "8", "10"));
}

TEST(Scale, KeepsTheRangeThatTheAxisAsksFor) {
  const std::vector<double> values = {-5, 50};
  const Scale sut({"t [s]", false, 0, 1}, values, 4);
  EXPECT_DOUBLE_EQ(sut.low(), 0);
  EXPECT_DOUBLE_EQ(sut.high(), 1);
  EXPECT_DOUBLE_EQ(sut.fraction(0.25), 0.25);
  EXPECT_DOUBLE_EQ(sut.fraction(50), 1);
  EXPECT_DOUBLE_EQ(sut.fraction(-5), 0);
}

TEST(Scale, LabelsDecadesOfALogarithmicAxisAndMarksWhatLiesBetween) {
  const std::vector<double> values = {3e-7, 0.02, 0.0, -1.0};
  const Scale sut({"error [m]", true}, values, 8);
  EXPECT_NEAR(sut.low(), 1e-7, 1e-16);
  EXPECT_NEAR(sut.high(), 0.1, 1e-12);
  EXPECT_THAT(labels(sut), ElementsAre("10⁻⁷", "10⁻⁶", "10⁻⁵", "10⁻⁴", "10⁻³", "0.01", "0.1"));
  EXPECT_GT(sut.ticks().size(), 40U);
  EXPECT_NEAR(sut.fraction(1e-4), 0.5, 1e-9);
  EXPECT_NEAR(sut.value(0.5), 1e-4, 1e-12);
  EXPECT_EQ(sut.fraction(0.0), 0.0);
}

TEST(Scale, LeavesDecadesOutWhereThereIsNoRoomForAllLabels) {
  const std::vector<double> values = {1e-16, 1.0};
  const Scale sut({"", true}, values, 6);
  EXPECT_LE(labels(sut).size(), 7U);
  EXPECT_GE(labels(sut).size(), 4U);
}

TEST(Scale, IsUsableWithoutDataWithOneValueAndWithHostileValues) {
  const double inf = std::numeric_limits<double>::infinity();
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const bool logarithmic : {false, true}) {
    const std::vector<std::vector<double>> cases = {{},
                                                    {0.0},
                                                    {7.0},
                                                    {-3.0, -3.0},
                                                    {nan, inf, -inf},
                                                    {1e308, -1e308},
                                                    {1e-308, 5e-324},
                                                    {1.0, 1.0 + 1e-15},
                                                    {1e300, 1e-300}};
    for (const auto& values : cases) {
      const Scale sut({"", logarithmic}, values, 6);
      EXPECT_LT(sut.low(), sut.high());
      EXPECT_LT(sut.ticks().size(), 10'000U);
      for (const double value : values) {
        EXPECT_GE(sut.fraction(value), 0.0);
        EXPECT_LE(sut.fraction(value), 1.0);
      }
    }
  }
}

TEST(Counts, PutsEveryNumberIntoOneBin) {
  const Scale x({"", false, 0, 10}, {}, 5);
  const Histogram histogram{{0.0, 0.5, 1.0, 9.99, 10.0, 11.0, -1.0, std::nan("")}, 10};
  EXPECT_THAT(counts(histogram, x), ElementsAre(3, 1, 0, 0, 0, 0, 0, 0, 0, 3));
}

}  // namespace
}  // namespace cellmirror::plot
