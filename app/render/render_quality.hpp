// Whether there is time for anti-aliasing, which is two thirds of the work where a processor draws: pictures that
// are requested continuously are drawn without it while they would otherwise come less often than requested. One
// thread: the pictures'.
#pragma once

#include <algorithm>

#include "rt_core/base/time.hpp"

namespace cellmirror::app {

class RenderQuality {
 public:
  // Before each round: how many different pictures a second are requested by all who look.
  void begin_cycle(double requested_hz) {
    const double load = requested_hz * changing_ * smooth_s_;  // of the one thread that draws
    smooth_ = load <= (smooth_ ? kOff : kOnAgain);
  }
  // A picture was drawn in that time, or had not to be because nothing had changed.
  void drew(Nanoseconds took) {
    const double took_s = seconds(took);
    changing_ += kWeight * (1 - changing_);
    // Without anti-aliasing the estimate fades, so that it is tried again after some hundred pictures: the machine may
    // have more time by then.
    smooth_s_ = smooth_ ? smooth_s_ + kWeight * (took_s - smooth_s_) : std::max(took_s, smooth_s_ * kFading);
  }
  void unchanged() { changing_ -= kWeight * changing_; }

  [[nodiscard]] bool antialiasing() const { return smooth_; }

 private:
  static constexpr double kOff = 0.9;
  static constexpr double kOnAgain = 0.6;
  static constexpr double kWeight = 0.1;
  static constexpr double kFading = 0.998;
  bool smooth_ = true;
  double changing_ = 0;  // share of the pictures that had to be drawn
  double smooth_s_ = 0;  // of one drawing with anti-aliasing
};

}  // namespace cellmirror::app
