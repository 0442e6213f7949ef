#include "drivers/can/canopen/heartbeat_cadence.hpp"

#include <cmath>

namespace cellmirror::can {

bool HeartbeatCadence::near(Nanoseconds a, Nanoseconds b) {
  return std::abs(seconds(a - b)) <= kTolerance * seconds(b);
}

bool HeartbeatCadence::take(Timestamp now) {
  const bool third = before_last_.known();
  const Nanoseconds pair = now - before_last_;
  const Nanoseconds interval = now - last_;
  const bool second = last_.known();
  before_last_ = last_;
  last_ = now;
  if (!second) return false;
  const bool shorter = period_.count() > 0 && interval < period_ && !near(interval, period_);
  if (shorter && third && near(pair, period_)) {
    if (pairs_ < kPairs) ++pairs_;
    return pairs_ >= kPairs;
  }
  pairs_ = 0;
  regular_ = near(interval, candidate_) ? regular_ + 1 : 0;
  candidate_ = interval;
  if (regular_ + 1 >= kRegular) period_ = interval;
  return false;
}

}  // namespace cellmirror::can
