// Flow control of one client. Pure: time is passed in.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "rt_core/base/time.hpp"

namespace cellmirror::web {

// A client has at most two pictures under way: one that it draws and one that is sent meanwhile.
class PictureCredit {
 public:
  static constexpr std::uint32_t kMostUnderWay = 2;

  [[nodiscard]] bool may_send() const { return sent_ - shown_ < kMostUnderWay; }
  // The sequence of the picture that is sent now; counts from 1 for each client.
  std::uint32_t next() { return ++sent_; }
  // All pictures up to `sequence` were shown. A sequence that was never sent is ignored.
  void shown(std::uint32_t sequence) {
    if (sequence > shown_ && sequence <= sent_) shown_ = sequence;
  }

 private:
  std::uint32_t sent_ = 0;
  std::uint32_t shown_ = 0;
};

// A token bucket: `per_second` on average, twice as many at once.
class RateLimit {
 public:
  explicit RateLimit(double per_second) : per_second_(per_second), left_(2.0 * per_second) {}

  [[nodiscard]] bool allows(Timestamp now) { return allows(1, now); }
  // Allows all of `number`, or none.
  [[nodiscard]] bool allows(std::size_t number, Timestamp now) {
    if (last_.known()) left_ = std::min(2.0 * per_second_, left_ + per_second_ * std::max(0.0, seconds(now - last_)));
    last_ = now;
    const auto cost = static_cast<double>(number);
    if (left_ < cost) return false;
    left_ -= cost;
    return true;
  }

 private:
  double per_second_;
  double left_;
  Timestamp last_;
};

}  // namespace cellmirror::web
