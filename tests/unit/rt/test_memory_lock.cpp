#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <thread>

#include "rt_core/rt/memory_lock.hpp"
#include "tests/unit/rt/in_child.hpp"

namespace cellmirror {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

constexpr std::uint64_t kMiB = 1024 * 1024;

std::string words(const MemoryLockOutcome& outcome) {
  const char* level = outcome.level == MemoryLockLevel::all       ? "all"
                      : outcome.level == MemoryLockLevel::current ? "current"
                                                                  : "none";
  return std::string(level) + "|" + (outcome.ok ? "ok" : "not ok") + "|" + outcome.why_not + "|" + outcome.remedy;
}

// "VmLck" of /proc/self/status, proc(5).
std::uint64_t locked_kib() {
  std::ifstream status("/proc/self/status");
  std::string word;
  while (status >> word) {
    if (word == "VmLck:") {
      std::uint64_t kib = 0;
      status >> kib;
      return kib;
    }
  }
  return 0;
}

// Whether memory can still be had in blocks of both kinds, and by a new thread.
bool memory_is_still_given() {
  volatile char* block = static_cast<volatile char*>(std::malloc(32 * kMiB));
  if (block == nullptr) {
    return false;
  }
  for (std::size_t i = 0; i < 32 * kMiB; i += 4096) {
    block[i] = 1;
  }
  std::free(const_cast<char*>(block));
  bool ran = false;
  std::thread([&ran] { ran = true; }).join();
  return ran;
}

TEST(MemoryLock, OffLocksNothingAndIsFine) {
  const MemoryLockOutcome sut = lock_memory(RealTimePolicy::off);
  EXPECT_TRUE(sut.ok);
  EXPECT_EQ(sut.level, MemoryLockLevel::none);
}

TEST(MemoryLock, WithoutALimitEverythingIsLocked) {
#ifdef CELLMIRROR_SANITIZED
  GTEST_SKIP() << "skipped: sanitizers turn mlockall off";
#endif
  if (!probe_memory_lock().ok) {
    GTEST_SKIP() << "skipped: " << probe_memory_lock().why_not;
  }
  const std::string sut = in_child([] {
    const MemoryLockOutcome outcome = lock_memory(RealTimePolicy::require);
    return words(outcome) + (locked_kib() > 1024 ? "locked" : "not locked") + "|" +
           (memory_is_still_given() ? "memory" : "no memory");
  });
  EXPECT_EQ(sut, "all|ok||locked|memory");
}

TEST(MemoryLock, ASmallLimitIsToldAndLaterMemoryIsStillGiven) {
#ifdef CELLMIRROR_SANITIZED
  GTEST_SKIP() << "skipped: sanitizers turn mlockall off";
#endif
  if (geteuid() != 0) {
    GTEST_SKIP() << "skipped: only root can become an ordinary user";
  }
  const std::string sut = in_child([] {
    if (!become_ordinary_user(64 * 1024)) {
      return std::string("cannot become an ordinary user");
    }
    const MemoryLockOutcome outcome = lock_memory(RealTimePolicy::prefer);
    return words(outcome) + "|" + (enforce(RealTimePolicy::require, outcome) ? "passes" : "refused") + "|" +
           (memory_is_still_given() ? "memory" : "no memory");
  });
  EXPECT_THAT(sut, StartsWith("none|not ok|memory cannot be locked: the process maps "));
  EXPECT_THAT(sut, HasSubstr("RLIMIT_MEMLOCK is 64 KiB")) << "the soft limit was raised to the hard one";
  EXPECT_THAT(sut, HasSubstr("memlock unlimited"));
  EXPECT_THAT(sut, testing::EndsWith("|refused|memory"));
}

TEST(MemoryLock, ALimitAboveTheMappedMemoryLocksThatOnly) {
#ifdef CELLMIRROR_SANITIZED
  GTEST_SKIP() << "skipped: sanitizers turn mlockall off";
#endif
  if (geteuid() != 0) {
    GTEST_SKIP() << "skipped: only root can become an ordinary user";
  }
  const std::string sut = in_child([] {
    // Enough for what a test program maps; too little for what memory_is_still_given() asks for on top.
    const std::uint64_t limit = lock_memory(RealTimePolicy::off).mapped_bytes + kMiB / 2;
    if (!become_ordinary_user(limit)) {
      return std::string("cannot become an ordinary user");
    }
    const MemoryLockOutcome outcome = lock_memory(RealTimePolicy::prefer);
    return words(outcome) + "|" + (locked_kib() > 1024 ? "locked" : "not locked") + "|" +
           (memory_is_still_given() ? "memory" : "no memory");
  });
  if (sut == "cannot become an ordinary user") {
    GTEST_SKIP() << "skipped: RLIMIT_MEMLOCK cannot be set to what a test program maps";
  }
  EXPECT_THAT(sut, StartsWith("current|not ok|only the memory mapped at the start"));
  EXPECT_THAT(sut, testing::EndsWith("|locked|memory"));
}

TEST(MemoryLock, TheProbeLocksNothing) {
#ifdef CELLMIRROR_SANITIZED
  GTEST_SKIP() << "skipped: sanitizers turn mlockall off";
#endif
  const std::uint64_t before = locked_kib();
  const MemoryLockOutcome sut = probe_memory_lock();
  EXPECT_GT(sut.mapped_bytes, 0U);
  EXPECT_EQ(locked_kib(), before);
}

TEST(MemoryLock, TheStackIsPrefaultedWithinItsBounds) {
  prefault_stack(0);
  prefault_stack(1);
  prefault_stack(kMostStackPrefault * 100);  // bounded, else this thread's stack would overflow
  SUCCEED();
}

TEST(CpuLatencyRequest, IsTakenOrSaysWhyNot) {
  const CpuLatencyRequest sut(0);
  EXPECT_EQ(sut.ok(), sut.why_not().empty());
  if (!sut.ok()) {
    EXPECT_FALSE(sut.remedy().empty());
  }
}

}  // namespace
}  // namespace cellmirror
