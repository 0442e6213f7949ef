#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <pthread.h>
#include <sys/resource.h>
#include <unistd.h>

#include <array>
#include <thread>

#include "rt_core/rt/cyclic_thread.hpp"
#include "rt_core/rt/scheduling.hpp"
#include "tests/unit/rt/in_child.hpp"

namespace cellmirror {
namespace {

using testing::HasSubstr;

TEST(Scheduling, OffChangesNothingAndIsFine) {
  const SchedulingOutcome before = current_scheduling();
  const SchedulingOutcome sut = set_real_time_scheduling(RealTimePolicy::off, 80);
  EXPECT_TRUE(sut.ok);
  EXPECT_EQ(sut.scheduler, before.scheduler);
  EXPECT_EQ(sut.priority, before.priority);
}

TEST(Scheduling, FifoIsSetWhereAllowedAndEndsWithItsThread) {
  const SchedulingOutcome before = current_scheduling();
  const SchedulingOutcome sut = probe_real_time_scheduling(10);
  if (!sut.ok) {
    GTEST_SKIP() << "skipped: " << sut.why_not << "; " << sut.remedy;
  }
  EXPECT_EQ(sut.scheduler, "SCHED_FIFO");
  EXPECT_EQ(sut.priority, 10);
  EXPECT_EQ(current_scheduling().scheduler, before.scheduler);
}

TEST(Scheduling, APriorityThatDoesNotExistIsRefusedWithTheRange) {
  const SchedulingOutcome sut = probe_real_time_scheduling(200);
  EXPECT_FALSE(sut.ok);
  EXPECT_THAT(sut.why_not, HasSubstr("200"));
  EXPECT_THAT(sut.remedy, HasSubstr("from 1 to 99"));
}

TEST(Scheduling, ShortWorkStaysInTheOrdinaryClassAndIsPreferredWhereAllowed) {
  // Above 0 where the whole check runs with a nice value.
  const int inherited = getpriority(PRIO_PROCESS, static_cast<id_t>(thread_id()));
  std::thread([inherited] {
    const bool preferred = prefer_short_work();
    EXPECT_EQ(current_scheduling().scheduler, "SCHED_OTHER");
    // Of Linux alone: the nice value of a thread.
    EXPECT_EQ(getpriority(PRIO_PROCESS, static_cast<id_t>(thread_id())), preferred ? -10 : inherited);
  }).join();
  EXPECT_EQ(getpriority(PRIO_PROCESS, static_cast<id_t>(thread_id())), inherited) << "only its own thread";
}

TEST(Scheduling, ShortWorkOfAnOrdinaryUserGoesOnUnpreferred) {
  if (geteuid() != 0) {
    GTEST_SKIP() << "skipped: only root can become an ordinary user";
  }
  const std::string sut = in_child([] {
    if (!become_ordinary_user(0)) {
      return std::string("cannot become an ordinary user");
    }
    const bool preferred = prefer_short_work();
    return std::string(preferred ? "preferred" : "as before") + "|" +
           std::to_string(getpriority(PRIO_PROCESS, static_cast<id_t>(thread_id()))) + "|" +
           current_scheduling().scheduler;
  });
  const int inherited = getpriority(PRIO_PROCESS, static_cast<id_t>(thread_id()));
  EXPECT_EQ(sut, "as before|" + std::to_string(inherited) + "|SCHED_OTHER");
}

TEST(Scheduling, AnOrdinaryUserIsToldWhatIsInForceWhyAndWhatToDo) {
  if (geteuid() != 0) {
    GTEST_SKIP() << "skipped: only root can become an ordinary user";
  }
  const std::string sut = in_child([] {
    if (!become_ordinary_user(0)) {
      return std::string("cannot become an ordinary user");
    }
    const SchedulingOutcome outcome = set_real_time_scheduling(RealTimePolicy::prefer, 80);
    return outcome.scheduler + "|" + (outcome.ok ? "ok" : "not ok") + "|" + outcome.why_not + "|" + outcome.remedy +
           "|" + (enforce(RealTimePolicy::require, outcome) ? "passes" : "refused") + "|" +
           (enforce(RealTimePolicy::prefer, outcome) ? "passes" : "refused");
  });
  EXPECT_THAT(sut, HasSubstr("SCHED_OTHER|not ok|SCHED_FIFO priority 80 was refused: Operation not permitted|"));
  EXPECT_THAT(sut, HasSubstr("CAP_SYS_NICE"));
  EXPECT_THAT(sut, HasSubstr("rtprio 80"));
  EXPECT_THAT(sut, testing::EndsWith("|refused|passes"));
}

TEST(Scheduling, AThreadNameIsCutAtWhatTheKernelKeeps) {
  std::array<char, 32> name{};
  std::thread([&] {
    set_thread_name("a name that is too long");
    pthread_getname_np(pthread_self(), name.data(), name.size());
  }).join();
  EXPECT_STREQ(name.data(), "a name that is ");
}

TEST(Scheduling, AProcessorThatDoesNotExistIsRefused) {
  Result<void> negative;
  Result<void> beyond;
  std::thread([&] {
    negative = set_cpu_affinity(-1);
    beyond = set_cpu_affinity(100'000);
  }).join();
  EXPECT_FALSE(negative);
  ASSERT_FALSE(beyond);
  EXPECT_THAT(beyond.error().what, HasSubstr("100000"));
}

}  // namespace
}  // namespace cellmirror
