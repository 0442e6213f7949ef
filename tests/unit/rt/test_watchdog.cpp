#include <gtest/gtest.h>

#include <semaphore>
#include <vector>

#include "rt_core/rt/watchdog.hpp"

namespace cellmirror {
namespace {

constexpr Nanoseconds kMillisecond{1'000'000};

class WatchdogTest : public testing::Test {
 protected:
  // Checks every 2 ms for `duration`, with a beat before each check if `beating`. The last answer.
  bool run(Nanoseconds duration, bool beating) {
    bool well = true;
    for (Nanoseconds t{0}; t < duration; t += 2 * kMillisecond) {
      clock_.advance(2 * kMillisecond);
      if (beating) {
        sut_.beat();
      }
      well = sut_.check(clock_.now());
    }
    return well;
  }

  ManualClock clock_;
  std::vector<WatchdogFault> told_;
  Watchdog sut_{10 * kMillisecond, [this](const WatchdogFault& fault) { told_.push_back(fault); }};
};

TEST_F(WatchdogTest, UnarmedItWatchesNothing) {
  EXPECT_TRUE(run(100 * kMillisecond, false));
  EXPECT_FALSE(sut_.faulted());
}

TEST_F(WatchdogTest, BeatsKeepItQuiet) {
  sut_.arm(clock_.now());
  EXPECT_TRUE(run(100 * kMillisecond, true));
  EXPECT_EQ(sut_.beats(), 50U);
  EXPECT_TRUE(told_.empty());
}

TEST_F(WatchdogTest, SilenceIsAFaultToldOnceWithItsLength) {
  sut_.arm(clock_.now());
  run(20 * kMillisecond, true);
  EXPECT_TRUE(run(10 * kMillisecond, false)) << "not yet longer than the timeout";
  EXPECT_FALSE(run(50 * kMillisecond, false));
  ASSERT_EQ(told_.size(), 1U);
  EXPECT_EQ(told_[0].silence, 12 * kMillisecond);
  EXPECT_EQ(told_[0].beats, 10U);
  EXPECT_EQ(sut_.faults(), 1U);
}

TEST_F(WatchdogTest, AFaultStaysAlthoughTheBeatsComeBack) {
  sut_.arm(clock_.now());
  run(20 * kMillisecond, false);
  EXPECT_FALSE(run(20 * kMillisecond, true));
  EXPECT_TRUE(sut_.faulted());
  ASSERT_TRUE(sut_.fault());
  EXPECT_EQ(told_.size(), 1U);
}

TEST_F(WatchdogTest, AfterAResetItWatchesAnew) {
  sut_.arm(clock_.now());
  run(20 * kMillisecond, false);
  sut_.reset(clock_.now());
  EXPECT_FALSE(sut_.faulted());
  EXPECT_FALSE(sut_.fault());
  EXPECT_TRUE(run(20 * kMillisecond, true));
  EXPECT_FALSE(run(20 * kMillisecond, false));
  EXPECT_EQ(told_.size(), 2U);
  EXPECT_EQ(sut_.faults(), 2U);
}

TEST_F(WatchdogTest, AStandstillOfTheWholeMachineIsNoFault) {
  sut_.arm(clock_.now());
  run(20 * kMillisecond, true);
  clock_.advance(500 * kMillisecond);  // neither beats nor checks
  EXPECT_TRUE(sut_.check(clock_.now()));
  EXPECT_FALSE(run(20 * kMillisecond, false)) << "but silence after it is";
}

TEST_F(WatchdogTest, TheCallbackMayReset) {
  Watchdog* self = nullptr;
  Watchdog sut(10 * kMillisecond, [&](const WatchdogFault& fault) { self->reset(fault.noticed); });
  self = &sut;
  sut.arm(clock_.now());
  for (int i = 0; i < 7; ++i) {
    clock_.advance(2 * kMillisecond);
    static_cast<void>(sut.check(clock_.now()));
  }
  EXPECT_FALSE(sut.faulted());
  EXPECT_EQ(sut.faults(), 1U);
}

TEST(WatchdogThread, NoticesByItself) {
  std::binary_semaphore told{0};
  Watchdog watchdog(Nanoseconds{20'000'000}, [&](const WatchdogFault&) { told.release(); });
  const SystemClock clock;
  const WatchdogThread sut(watchdog, clock);
  EXPECT_TRUE(told.try_acquire_for(std::chrono::seconds(20)));
  EXPECT_TRUE(watchdog.faulted());
}

}  // namespace
}  // namespace cellmirror
