// Whether heartbeats come as if two devices sent them: twice as often as they did, each pair as far apart as one was.
#pragma once

#include "rt_core/base/time.hpp"

namespace cellmirror::can {

// Of one node. A hint and no proof: a device that was set to half its period looks the same. Pure.
class HeartbeatCadence {
 public:
  static constexpr double kTolerance = 0.15;  // of the period
  static constexpr unsigned kRegular = 5;     // intervals in succession that make a period
  static constexpr unsigned kPairs = 8;       // in succession that make two senders

  // True while they come twice as often.
  bool take(Timestamp now);
  void restart() { *this = HeartbeatCadence(); }
  // Zero before it is known.
  [[nodiscard]] Nanoseconds period() const { return period_; }

 private:
  [[nodiscard]] static bool near(Nanoseconds a, Nanoseconds b);

  Timestamp last_;
  Timestamp before_last_;
  Nanoseconds candidate_{0};
  Nanoseconds period_{0};
  unsigned regular_ = 0;
  unsigned pairs_ = 0;
};

}  // namespace cellmirror::can
