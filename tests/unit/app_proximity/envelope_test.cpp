#include "app/proximity/envelope.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace cellmirror::app {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

TEST(Envelope, keepsShortRowsAsTheyAre) {
  Envelope sut;
  for (const double value : {3.0, kNone, 1.0}) sut.add(value);
  ASSERT_EQ(sut.values().size(), 3U);
  EXPECT_EQ(sut.values()[0], 3.0);
  EXPECT_TRUE(std::isnan(sut.values()[1])) << "a gap";
  EXPECT_EQ(sut.numbers(), (std::vector<double>{1.0, 2.0, 3.0}));
}

TEST(Envelope, losesNoDipOfALongRow) {
  constexpr std::size_t kValues = 1'000'000;
  constexpr std::size_t kDip = 654'321;  // from 0
  Envelope sut;
  for (std::size_t i = 0; i < kValues; ++i) sut.add(i == kDip ? 0.25 : (i % 3 == 0 ? kNone : 1.0));
  EXPECT_LE(sut.values().size(), Envelope::kMostPoints);
  const std::vector<double> numbers = sut.numbers();
  std::size_t dips = 0;
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    ASSERT_FALSE(std::isnan(sut.values()[i]));
    if (sut.values()[i] == 1.0) continue;
    ++dips;
    EXPECT_LE(numbers[i], kDip + 1.0);
    EXPECT_GT(i + 1 < numbers.size() ? numbers[i + 1] : 1e9, kDip + 1.0) << "at its place";
  }
  EXPECT_EQ(dips, 1U);
}

}  // namespace
}  // namespace cellmirror::app
