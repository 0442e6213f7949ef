// Periods on the monotonic clock: absolute, so that errors do not add up; phase kept when some are missed.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "rt_core/base/contract.hpp"
#include "rt_core/base/time.hpp"

namespace cellmirror::sim {

// Of a rate above 0; at least a nanosecond.
[[nodiscard]] inline Nanoseconds period_of(double rate_hz) {
  return Nanoseconds(std::max<std::int64_t>(std::llround(1e9 / rate_hz), 1));
}

class Pacer {
 public:
  Pacer(Timestamp first, Nanoseconds period) : next_(first), period_(period) { CELLMIRROR_EXPECTS(period.count() > 0); }

  [[nodiscard]] Timestamp next() const { return next_; }
  [[nodiscard]] bool due(Timestamp now) const { return next_ <= now; }
  // To be called when due: moves on to the first instant after `now`, counts the ones in between as missed.
  void advance(Timestamp now) {
    const std::int64_t periods = std::max<std::int64_t>((now - next_) / period_, 0) + 1;
    missed_ += static_cast<std::uint64_t>(periods - 1);
    next_ = next_ + periods * period_;
  }
  [[nodiscard]] std::uint64_t missed() const { return missed_; }
  [[nodiscard]] Nanoseconds period() const { return period_; }

 private:
  Timestamp next_;
  Nanoseconds period_;
  std::uint64_t missed_ = 0;
};

// clock_nanosleep to an absolute instant; returns earlier where a signal comes.
void sleep_until(Timestamp t);

}  // namespace cellmirror::sim
