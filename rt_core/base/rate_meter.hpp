// How many events a second. Time is handed in. Not synchronized.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "rt_core/base/real_time.hpp"
#include "rt_core/base/time.hpp"

namespace cellmirror {

// Events that are counted one by one. Slices of a tenth of a second: the cost is the same at every rate.
class RateMeter {
 public:
  void count(Timestamp now) CELL_RT {
    const std::int64_t number = now.ns / kSlice_ns;
    Slice& slice = slices_[static_cast<std::size_t>(number) % kSlices];
    if (slice.number != number) slice = {number, 0};
    ++slice.events;
  }
  // Over the ten whole slices before the one under way.
  [[nodiscard]] double per_second(Timestamp now) const CELL_RT {
    const std::int64_t number = now.ns / kSlice_ns;
    std::uint64_t events = 0;
    for (const Slice& slice : slices_) {
      if (slice.number < number && slice.number >= number - kSlicesOfASecond) events += slice.events;
    }
    return static_cast<double>(events);
  }

 private:
  struct Slice {
    std::int64_t number = -1;
    std::uint64_t events = 0;
  };
  static constexpr std::int64_t kSlice_ns = 100'000'000;
  static constexpr std::int64_t kSlicesOfASecond = 10;
  static constexpr std::size_t kSlices = 11;  // a second's whole ones, and the one under way

  std::array<Slice, kSlices> slices_{};
};

// The rate of a counter from readings of it.
class CounterRate {
 public:
  // The rate is that between two readings which are at least `window` apart; 0 before the second one.
  explicit CounterRate(Nanoseconds window) : window_(window) {}

  double read(Timestamp now, std::uint64_t count) {
    if (!since_.known()) {
      since_ = now;
      from_ = count;
    } else if (now - since_ >= window_) {
      per_second_ = static_cast<double>(count - from_) / seconds(now - since_);
      since_ = now;
      from_ = count;
    }
    return per_second_;
  }
  // The next reading is the first one.
  void restart() { *this = CounterRate(window_); }

 private:
  Nanoseconds window_;
  Timestamp since_;
  std::uint64_t from_ = 0;
  double per_second_ = 0;
};

}  // namespace cellmirror
