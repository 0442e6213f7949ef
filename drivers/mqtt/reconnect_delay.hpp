// How long to wait before the next attempt to connect: 1 s, doubled up to 30 s; from the beginning again once a
// connection has lasted. No clock.
#pragma once

#include <algorithm>
#include <chrono>

#include "rt_core/base/time.hpp"

namespace cellmirror::mqtt {

class ReconnectDelay {
 public:
  static constexpr Nanoseconds kFirst = std::chrono::seconds(1);
  static constexpr Nanoseconds kLongest = std::chrono::seconds(30);
  static constexpr Nanoseconds kLasting = std::chrono::seconds(5);  // a connection that is ended at once is none

  // After an attempt; `lasted`: how long it was connected, 0: never.
  [[nodiscard]] Nanoseconds after(Nanoseconds lasted) {
    if (lasted >= kLasting) next_ = kFirst;
    const Nanoseconds now = next_;
    next_ = std::min(2 * next_, kLongest);
    return now;
  }

 private:
  Nanoseconds next_ = kFirst;
};

}  // namespace cellmirror::mqtt
