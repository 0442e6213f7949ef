// When the first of several timers is due.
#pragma once

#include "rt_core/base/time.hpp"

namespace cellmirror::can {

// "Never" counts as later than any time.
[[nodiscard]] inline Timestamp earlier_due(Timestamp a, Timestamp b) {
  if (!a.known()) return b;
  return b.known() && b < a ? b : a;
}

}  // namespace cellmirror::can
