// When the next picture is due for a client with a requested rate. Pure: time is passed in.
#pragma once

#include <algorithm>
#include <cstdint>

#include "rt_core/base/time.hpp"

namespace cellmirror::app {

inline constexpr double kLowestPictureRate =
    0.01;  // a second: slower is as good as never, and periods have to be numbers
inline constexpr double kHighestPictureRate = 60;

[[nodiscard]] inline Nanoseconds picture_period(double rate_hz) {
  return Nanoseconds(static_cast<std::int64_t>(1e9 / std::max(rate_hz, kLowestPictureRate)));
}

// Whether it is due in the round at `now`, of which half is so long; then `due` is that of the next one. The rate may
// be another one each time: a low one that was wished before holds back nothing.
[[nodiscard]] inline bool picture_is_due(Timestamp& due, double rate_hz, Timestamp now, Nanoseconds half_round) {
  const Nanoseconds period = picture_period(rate_hz);
  if (due.known() && due > now + period) due = now + period;
  if (due.known() && due > now + half_round) return false;
  due = due.known() && now - due < period ? due + period : now + period;
  return true;
}

}  // namespace cellmirror::app
