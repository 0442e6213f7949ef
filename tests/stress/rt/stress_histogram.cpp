#include <gtest/gtest.h>

#include <memory>
#include <thread>

#include "rt_core/rt/latency_histogram.hpp"
#include "tests/stress/rt/patterned.hpp"

namespace cellmirror {
namespace {

TEST(LatencyHistogramStress, ReadersSeeOnlyWhatWasRecordedAndResetsLoseNothingElse) {
  const auto sut = std::make_unique<LatencyHistogram>();
  std::atomic<bool> done{false};
  std::thread writer([&] {
    for (std::uint64_t n = 0; n < kOperations; ++n) {
      sut->record(Nanoseconds{1000 + static_cast<std::int64_t>(n % 1000)});
    }
    done.store(true, std::memory_order_release);
  });
  std::uint64_t wrong = 0;
  for (int round = 0; !done.load(std::memory_order_acquire); ++round) {
    if (round % 50 == 0) {
      sut->request_reset();
    }
    const HistogramSnapshot snapshot = sut->snapshot();
    wrong += snapshot.max() <= Nanoseconds{1999} && snapshot.count() <= kOperations ? 0 : 1;
    wrong += snapshot.percentile(100) <= Nanoseconds{1999} ? 0 : 1;
  }
  writer.join();
  EXPECT_EQ(wrong, 0U);
  sut->request_reset();
  for (int i = 0; i < 10; ++i) {
    sut->record(Nanoseconds{7});
  }
  EXPECT_EQ(sut->count(), 10U);
  EXPECT_EQ(sut->max(), Nanoseconds{7});
}

}  // namespace
}  // namespace cellmirror
