// How old results are, seen by those who read them: from the instant of the posture to the moment the result can be
// read, and to the moment it is replaced by the next.
#pragma once

#include "rt_core/base/time.hpp"
#include "rt_core/rt/latency_histogram.hpp"

namespace cellmirror::app {

// One writer, any readers of the histograms.
class ResultAge {
 public:
  // A result for `posture` can be read since `now`.
  void shown(Timestamp posture, Timestamp now) {
    visible_after_.record(now - posture);
    // Nobody who reads can see the one before at a greater age than now.
    if (before_.known()) age_.record(now - before_);
    before_ = posture;
  }
  // Results were not wanted for a while: the age of the last one is no fault.
  void paused() { before_ = Timestamp(); }

  [[nodiscard]] const LatencyHistogram& age() const { return age_; }
  [[nodiscard]] const LatencyHistogram& visible_after() const { return visible_after_; }

 private:
  LatencyHistogram age_;
  LatencyHistogram visible_after_;
  Timestamp before_;
};

}  // namespace cellmirror::app
