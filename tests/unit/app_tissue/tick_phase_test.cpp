#include "app/workers/tick_phase.hpp"

#include <gtest/gtest.h>

#include <cstdint>

namespace cellmirror::app {
namespace {

constexpr Nanoseconds kPeriod{1'000'000};

// The age of the posture of the last of `count` steps, the first of which begins at `first` after a tick.
std::int64_t age_after(std::int64_t first, std::int64_t tick_period, int count) {
  std::int64_t begin = first;
  std::int64_t age = 0;
  for (int i = 0; i < count; ++i) {
    age = begin % tick_period;
    begin += (kPeriod + phase_change(Nanoseconds(age), kPeriod)).count();
  }
  return age;
}

TEST(TickPhase, StepsComeToBeginShortlyBehindTicksFromAnyPhase) {
  for (std::int64_t first = 0; first < kPeriod.count(); first += 50'000) {
    EXPECT_NEAR(static_cast<double>(age_after(first, kPeriod.count(), 100)), static_cast<double>(kTickToStep.count()),
                1.0)
        << first;
  }
}

TEST(TickPhase, TicksMayBeFasterOrSlowerByAWholeFactor) {
  EXPECT_EQ(age_after(300'000, 500'000, 100), kTickToStep.count());
  const std::int64_t slow = age_after(1'700'000, 2'000'000, 101);
  EXPECT_EQ(slow % kPeriod.count(), kTickToStep.count());
}

TEST(TickPhase, TheRateChangesByOnePercentAtMost) {
  for (std::int64_t age = 0; age < 5'000'000; age += 37'000) {
    const std::int64_t change = phase_change(Nanoseconds(age), kPeriod).count();
    EXPECT_LE(std::abs(change), kPeriod.count() / 100) << age;
  }
}

// A posture that is older than a tick, since the tick is late, does not turn the phase around.
TEST(TickPhase, ALateTickIsTakenForWhatItIs) {
  EXPECT_LT(phase_change(Nanoseconds(kPeriod.count() + kTickToStep.count() + 5'000), kPeriod).count(), 0);
  EXPECT_GT(phase_change(Nanoseconds(kPeriod.count() + 20'000), kPeriod).count(), 0);
}

}  // namespace
}  // namespace cellmirror::app
