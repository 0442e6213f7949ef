#include <gtest/gtest.h>

#include "app/workers/fault_monitor.hpp"

namespace cellmirror::app {
namespace {

constexpr Timestamp kStart{1'000'000'000};
constexpr std::chrono::milliseconds kStep{25};

TEST(OverloadRule, IsQuietWhileFewPeriodsAreMissed) {
  OverloadRule sut;
  for (int i = 0; i < 400; ++i) {
    // One missed period in each tenth of a second is ten a second.
    EXPECT_FALSE(sut.check(kStart + i * kStep, static_cast<std::uint64_t>(i / 4)));
  }
}

TEST(OverloadRule, TripsWhenAWindowHoldsTooManyMissedPeriods) {
  OverloadRule sut;
  EXPECT_FALSE(sut.check(kStart, 100));  // what was missed before does not count
  EXPECT_FALSE(sut.check(kStart + kStep, 100 + OverloadRule::kMissedInWindow - 1));
  EXPECT_TRUE(sut.check(kStart + 2 * kStep, 100 + OverloadRule::kMissedInWindow));
}

TEST(OverloadRule, TripsOnceForTheSameMissedPeriods) {
  OverloadRule sut;
  EXPECT_FALSE(sut.check(kStart, 0));
  EXPECT_TRUE(sut.check(kStart + kStep, 50));
  EXPECT_FALSE(sut.check(kStart + 2 * kStep, 50));
}

}  // namespace
}  // namespace cellmirror::app
