#include "drivers/can/alternation_watch.hpp"

#include <cmath>

namespace cellmirror::can {

bool AlternationWatch::take(double value, Timestamp now) {
  const double jump = std::abs(value - newest_);
  if (returned_.known() && now - returned_ > kWindow) returns_ = 0;
  if (taken_.known() && jump >= kSmallestJump) {
    const bool recent = other_taken_.known() && now - other_taken_ <= kWindow;
    if (recent && std::abs(value - other_) <= kReturnShare * jump) {
      if (returns_ < kReturns) ++returns_;
      returned_ = now;
    } else {
      returns_ = 0;
    }
    other_ = newest_;
    other_taken_ = taken_;
  }
  newest_ = value;
  taken_ = now;
  return returns_ >= kReturns;
}

}  // namespace cellmirror::can
