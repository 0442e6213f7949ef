// How long things take, recorded by a thread that must not be disturbed and read by any other.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>

#include "rt_core/base/real_time.hpp"
#include "rt_core/base/time.hpp"

namespace cellmirror {

// The buckets shared by LatencyHistogram and HistogramSnapshot: log-linear, as in HdrHistogram. Up to 127 ns each
// nanosecond has a bucket of its own; from there each power of two is divided into 64 equal buckets, so that a bucket
// is at most 1/64 (1.6 %) of its values wide.
struct LatencyBuckets {
  static constexpr Nanoseconds kLongest{100'000'000'000};  // longer ones count as this long (max() keeps the truth)
  static constexpr unsigned kSubBits = 6;
  static constexpr std::size_t kSubBuckets = std::size_t{1} << kSubBits;
  static constexpr std::size_t kCount = 2048;

  // The bucket of a duration; negative ones count as 0.
  [[nodiscard]] static std::size_t index(Nanoseconds duration) CELL_RT;
  // The longest duration that falls into the bucket.
  [[nodiscard]] static Nanoseconds upper_bound(std::size_t index) CELL_RT;
};

// A plain copy of a histogram: for percentiles, for printing, for adding several up. 16 KiB.
class HistogramSnapshot {
 public:
  [[nodiscard]] std::uint64_t count() const { return count_; }
  [[nodiscard]] bool empty() const { return count_ == 0; }
  // The smallest duration d such that at least `percent` (0..100) of the durations are no longer than d, rounded up by
  // at most 1.6 % and never above max(). Zero where nothing was recorded.
  [[nodiscard]] Nanoseconds percentile(double percent) const;
  [[nodiscard]] Nanoseconds max() const { return max_; }  // exact
  [[nodiscard]] Nanoseconds mean() const;                 // exact to the nanosecond; zero where nothing was recorded
  // How many durations were longer than `limit`, to within the width of limit's bucket (whose own count as not longer).
  [[nodiscard]] std::uint64_t count_above(Nanoseconds limit) const;
  // Adds what another histogram recorded.
  void merge(const HistogramSnapshot& other);

 private:
  friend class LatencyHistogram;
  std::array<std::uint64_t, LatencyBuckets::kCount> counts_{};
  std::uint64_t count_ = 0;
  std::int64_t sum_ns_ = 0;
  Nanoseconds max_{0};
};

// One writer thread records, any thread reads. All atomics are relaxed: a histogram publishes nothing but its own
// numbers, and a reader may miss the record that is just being made.
class LatencyHistogram {
 public:
  LatencyHistogram() = default;
  LatencyHistogram(const LatencyHistogram&) = delete;
  LatencyHistogram& operator=(const LatencyHistogram&) = delete;

  // Writer. Constant time, but for the first record after request_reset(), which clears 16 KiB (about a microsecond).
  void record(Nanoseconds duration) CELL_RT;

  // Any thread. Forgets everything recorded so far: readers see an empty histogram at once, the writer clears it with
  // its next record.
  void request_reset() CELL_RT { reset_requested_.store(true, std::memory_order_relaxed); }

  // Any thread, not the tick.
  [[nodiscard]] HistogramSnapshot snapshot() const;
  [[nodiscard]] Nanoseconds percentile(double percent) const { return snapshot().percentile(percent); }
  [[nodiscard]] Nanoseconds max() const { return snapshot().max(); }
  [[nodiscard]] std::uint64_t count() const { return snapshot().count(); }

 private:
  void clear() noexcept;

  std::array<std::atomic<std::uint64_t>, LatencyBuckets::kCount> counts_{};
  std::atomic<std::int64_t> sum_ns_{0};
  std::atomic<std::int64_t> max_ns_{0};
  std::atomic<bool> reset_requested_{false};
};

}  // namespace cellmirror
