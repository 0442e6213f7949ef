#include <gtest/gtest.h>
#include <malloc.h>

#include <cstdlib>
#include <memory>
#include <thread>
#include <vector>

#include "rt_core/rt/allocation_guard.hpp"
#include "rt_core/rt/fifo.hpp"
#include "rt_core/rt/latency_histogram.hpp"
#include "rt_core/rt/latest.hpp"
#include "rt_core/rt/ring.hpp"
#include "rt_core/rt/watchdog.hpp"

namespace cellmirror {
namespace {

// Keeps the compiler from removing a pair of malloc and free that it sees through.
void use(void* block) { asm volatile("" : : "r"(block) : "memory"); }

class AllocationGuardTest : public testing::Test {
 protected:
  void SetUp() override { ASSERT_TRUE(AllocationGuard::armed()) << "the interposer is not linked in"; }
};

TEST_F(AllocationGuardTest, CountsEveryKindOfAllocation) {
  void* blocks[8] = {};
  {
    const AllocationGuard sut;
    blocks[0] = std::malloc(10);
    blocks[1] = std::calloc(2, 10);
    blocks[2] = std::realloc(nullptr, 10);
    blocks[3] = std::aligned_alloc(64, 128);
    ASSERT_EQ(posix_memalign(&blocks[4], 64, 100), 0);
    blocks[5] = memalign(64, 100);
    blocks[6] = ::operator new(10);
    blocks[7] = ::operator new(10, std::align_val_t{64});
    EXPECT_EQ(sut.allocations(), 8U);
    EXPECT_EQ(sut.frees(), 0U);
    for (void* block : {blocks[0], blocks[1], blocks[2], blocks[3], blocks[4], blocks[5]}) {
      use(block);
      std::free(block);
    }
    ::operator delete(blocks[6]);
    ::operator delete(blocks[7], std::align_val_t{64});
    std::free(nullptr);
    EXPECT_EQ(sut.allocations(), 8U);
    EXPECT_EQ(sut.frees(), 8U) << "freeing nothing does not count";
  }
}

TEST_F(AllocationGuardTest, OutsideNothingIsCounted) {
  const std::uint64_t before = AllocationGuard::allocations_in_guard();
  void* block = std::malloc(10);
  use(block);
  std::free(block);
  EXPECT_EQ(AllocationGuard::allocations_in_guard(), before);
}

TEST_F(AllocationGuardTest, Nests) {
  const AllocationGuard outer;
  void* first = std::malloc(1);
  use(first);
  {
    const AllocationGuard inner;
    void* second = std::malloc(1);
    use(second);
    std::free(second);
    EXPECT_EQ(inner.allocations(), 1U);
  }
  std::free(first);
  EXPECT_EQ(outer.allocations(), 2U);
  EXPECT_EQ(outer.frees(), 2U);
}

TEST_F(AllocationGuardTest, OtherThreadsDoNotCountForThisOneButForTheProcess) {
  const std::uint64_t process_before = AllocationGuard::allocations_in_guard_of_process();
  const std::uint64_t thread_before = AllocationGuard::allocations_in_guard();
  std::thread([] {
    const AllocationGuard guard;
    void* block = std::malloc(1);
    use(block);
    std::free(block);
  }).join();
  EXPECT_EQ(AllocationGuard::allocations_in_guard(), thread_before);
  EXPECT_EQ(AllocationGuard::allocations_in_guard_of_process(), process_before + 1);
}

TEST_F(AllocationGuardTest, PosixMemalignKeepsItsContract) {
#ifdef CELLMIRROR_SANITIZED
  GTEST_SKIP() << "skipped: a sanitizer ends the program at an alignment of 3";
#endif
  void* block = this;
  errno = 42;
  EXPECT_EQ(posix_memalign(&block, 3, 10), EINVAL);
  EXPECT_EQ(posix_memalign(&block, sizeof(void*), SIZE_MAX / 2), ENOMEM);
  EXPECT_EQ(block, this);
  EXPECT_EQ(errno, 42);
}

TEST_F(AllocationGuardTest, TheEdgesAndTheHistogramLeaveTheHeapAlone) {
  struct Sample {
    double values[32];
  };
  const auto fifo = std::make_unique<Fifo<Sample, 64>>();
  const auto latest = std::make_unique<Latest<Sample>>();
  const auto ring = std::make_unique<Ring<Sample, 64>>();
  const auto histogram = std::make_unique<LatencyHistogram>();
  Watchdog watchdog(Nanoseconds{1'000'000}, {});
  std::uint64_t allocations = 0;
  std::uint64_t frees = 0;
  {
    const AllocationGuard sut;
    Sample sample{};
    for (int i = 0; i < 1000; ++i) {
      sample.values[0] = i;
      fifo->push(sample);
      if (i % 100 == 0) {
        while (fifo->pop(sample)) {
        }
      }
      latest->write(sample);
      latest->writable().values[1] = i;
      latest->publish();
      static_cast<void>(latest->read());
      ring->push(sample);
      if (i == 500) {
        histogram->request_reset();
      }
      histogram->record(Nanoseconds{i * 1000});
      watchdog.beat();
    }
    allocations = sut.allocations();
    frees = sut.frees();
  }
  EXPECT_EQ(allocations, 0U);
  EXPECT_EQ(frees, 0U);
}

}  // namespace
}  // namespace cellmirror
