// Delay before a process that has ended is started again. Pure.
#pragma once

#include <algorithm>

#include "rt_core/base/time.hpp"

namespace cellmirror {

// The first kAtOnce restarts follow at once, so that a passing fault costs less than two seconds. Under a continuing
// attack there is one restart per kEach.
class RestartDelay {
 public:
  static constexpr int kAtOnce = 5;
  static constexpr Nanoseconds kEach{2'000'000'000};
  static constexpr Nanoseconds kShortest{50'000'000};

  // The delay after an end at `now`.
  [[nodiscard]] Nanoseconds after_end(Timestamp now) {
    // Each restart uses up kEach of time; at most kAtOnce of them are saved up.
    spent_until_ = std::max(spent_until_, now - kEach * kAtOnce) + kEach;
    return std::max(spent_until_ - now, kShortest);
  }

 private:
  Timestamp spent_until_;
};

}  // namespace cellmirror
