#include "rt_core/base/time.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <limits>

namespace cellmirror {
namespace {

TEST(Time, WallClockAndMonotonicTimeGoThereAndBack) {
  const Timestamp now = SystemClock().now();
  const Timestamp back = from_wall_clock_ns(to_wall_clock_ns(now));
  EXPECT_LT(std::abs((back - now).count()), 10'000'000);  // the two readings of the clocks lie that close together
}

TEST(Time, WallClockTimesBeforeTheStartOrOutOfRangeAreNever) {
  for (const std::int64_t hostile :
       {std::int64_t{0}, std::int64_t{-1}, std::int64_t{1}, std::numeric_limits<std::int64_t>::min()}) {
    EXPECT_FALSE(from_wall_clock_ns(hostile).known()) << hostile;
  }
}

TEST(ManualClock, MovesOnlyWhenTold) {
  ManualClock sut;
  const Timestamp start = sut.now();
  sut.advance(std::chrono::milliseconds(3));
  EXPECT_EQ(sut.now() - start, std::chrono::milliseconds(3));
}

}  // namespace
}  // namespace cellmirror
