#include "rt_core/rt/latency_histogram.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

namespace cellmirror {

namespace {

constexpr std::size_t kLinear = 2 * LatencyBuckets::kSubBuckets;  // values below have a bucket each

// One writer: a plain load and store saves the locked instruction.
template <class T>
void add(std::atomic<T>& counter, T value) noexcept {
  counter.store(counter.load(std::memory_order_relaxed) + value, std::memory_order_relaxed);
}

}  // namespace

std::size_t LatencyBuckets::index(Nanoseconds duration) CELL_RT {
  const auto value = static_cast<std::uint64_t>(std::clamp<std::int64_t>(duration.count(), 0, kLongest.count()));
  if (value < kLinear) {
    return static_cast<std::size_t>(value);
  }
  // Shifted so that the highest set bit is kSubBits: 64..127 within the octave.
  const unsigned shift = static_cast<unsigned>(std::bit_width(value)) - (kSubBits + 1);
  const std::uint64_t within = (value >> shift) - kSubBuckets;
  return kLinear + (shift - 1) * kSubBuckets + static_cast<std::size_t>(within);
}

Nanoseconds LatencyBuckets::upper_bound(std::size_t index) CELL_RT {
  if (index < kLinear) {
    return Nanoseconds(static_cast<std::int64_t>(index));
  }
  const std::size_t octave = (index - kLinear) / kSubBuckets;
  const std::uint64_t within = (index - kLinear) % kSubBuckets;
  const unsigned shift = static_cast<unsigned>(octave) + 1;
  return Nanoseconds(static_cast<std::int64_t>(((kSubBuckets + within + 1) << shift) - 1));
}

static_assert(kLinear + 30 * LatencyBuckets::kSubBuckets == LatencyBuckets::kCount,
              "30 octaves above 2^7 reach 2^37 ns = 137 s, beyond kLongest");

void LatencyHistogram::record(Nanoseconds duration) CELL_RT {
  if (reset_requested_.load(std::memory_order_relaxed)) {
    clear();
    reset_requested_.store(false, std::memory_order_relaxed);
  }
  const std::int64_t ns = std::max<std::int64_t>(duration.count(), 0);
  if (ns > max_ns_.load(std::memory_order_relaxed)) {
    max_ns_.store(ns, std::memory_order_relaxed);
  }
  add(sum_ns_, ns);
  add(counts_[LatencyBuckets::index(duration)], std::uint64_t{1});
}

void LatencyHistogram::clear() noexcept {
  for (auto& count : counts_) {
    count.store(0, std::memory_order_relaxed);
  }
  sum_ns_.store(0, std::memory_order_relaxed);
  max_ns_.store(0, std::memory_order_relaxed);
}

HistogramSnapshot LatencyHistogram::snapshot() const {
  HistogramSnapshot copy;
  if (reset_requested_.load(std::memory_order_relaxed)) {
    return copy;
  }
  for (std::size_t i = 0; i < counts_.size(); ++i) {
    copy.counts_[i] = counts_[i].load(std::memory_order_relaxed);
    copy.count_ += copy.counts_[i];  // counted here, so that percentiles of the copy are coherent
  }
  copy.sum_ns_ = sum_ns_.load(std::memory_order_relaxed);
  copy.max_ = Nanoseconds(max_ns_.load(std::memory_order_relaxed));
  return copy;
}

Nanoseconds HistogramSnapshot::percentile(double percent) const {
  if (count_ == 0) {
    return Nanoseconds{0};
  }
  const double fraction = std::clamp(percent, 0.0, 100.0) / 100.0;
  const auto rank = static_cast<std::uint64_t>(std::ceil(fraction * static_cast<double>(count_)));
  const std::uint64_t wanted = std::clamp<std::uint64_t>(rank, 1, count_);
  std::uint64_t seen = 0;
  for (std::size_t i = 0; i < counts_.size(); ++i) {
    seen += counts_[i];
    if (seen >= wanted) {
      return std::min(LatencyBuckets::upper_bound(i), max_);
    }
  }
  return max_;
}

Nanoseconds HistogramSnapshot::mean() const {
  return Nanoseconds(count_ == 0 ? 0 : sum_ns_ / static_cast<std::int64_t>(count_));
}

std::uint64_t HistogramSnapshot::count_above(Nanoseconds limit) const {
  std::uint64_t above = 0;
  for (std::size_t i = LatencyBuckets::index(limit) + 1; i < counts_.size(); ++i) {
    above += counts_[i];
  }
  return above;
}

void HistogramSnapshot::merge(const HistogramSnapshot& other) {
  for (std::size_t i = 0; i < counts_.size(); ++i) {
    counts_[i] += other.counts_[i];
  }
  count_ += other.count_;
  sum_ns_ += other.sum_ns_;
  max_ = std::max(max_, other.max_);
}

}  // namespace cellmirror
