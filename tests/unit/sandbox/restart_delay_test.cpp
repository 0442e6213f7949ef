#include "ipc/sandbox/restart_delay.hpp"

#include <gtest/gtest.h>

namespace cellmirror {
namespace {

using std::chrono::milliseconds;

constexpr Timestamp kBegin{1'000'000'000'000};

TEST(RestartDelay, StartsAgainAtOnceAfterAFaultThatPasses) {
  RestartDelay sut;
  EXPECT_EQ(sut.after_end(kBegin), RestartDelay::kShortest);
}

TEST(RestartDelay, StartsAgainAtOnceForEverWhereFaultsAreFarApart) {
  RestartDelay sut;
  Timestamp now = kBegin;
  for (int i = 0; i < 1000; ++i, now = now + RestartDelay::kEach)
    ASSERT_EQ(sut.after_end(now), RestartDelay::kShortest) << i;
}

TEST(RestartDelay, BoundsTheRateUnderAContinuingAttack) {
  RestartDelay sut;
  Timestamp now = kBegin;
  int starts = 0;
  for (; now - kBegin < milliseconds(60'000); ++starts) now = now + sut.after_end(now);
  EXPECT_LE(starts, 30 + RestartDelay::kAtOnce + 1);
  EXPECT_GE(starts, 25) << "it goes on trying";
}

TEST(RestartDelay, NeverWaitsLongerThanTwoSeconds) {
  RestartDelay sut;
  Timestamp now = kBegin;
  for (int i = 0; i < 100; ++i) {
    const Nanoseconds delay = sut.after_end(now);
    ASSERT_LE(delay, RestartDelay::kEach);
    now = now + delay;
  }
}

}  // namespace
}  // namespace cellmirror
