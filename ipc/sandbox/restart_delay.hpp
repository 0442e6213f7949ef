// How long a process that has ended is not started again. Pure.
#pragma once

#include <algorithm>

#include "rt_core/base/time.hpp"

namespace cellmirror {

// A few restarts come at once, so that a fault that passes costs less than two seconds; under a continuing attack there
// is one per kEach.
class RestartDelay {
 public:
  static constexpr int kAtOnce = 5;
  static constexpr Nanoseconds kEach{2'000'000'000};
  static constexpr Nanoseconds kShortest{50'000'000};

  // `now`: when the process ended. From then on to the next start.
  [[nodiscard]] Nanoseconds after_end(Timestamp now) {
    // The time up to which restarts are spent, each for kEach; it is never further back than kAtOnce of them.
    spent_until_ = std::max(spent_until_, now - kEach * kAtOnce) + kEach;
    return std::max(spent_until_ - now, kShortest);
  }

 private:
  Timestamp spent_until_;
};

}  // namespace cellmirror
