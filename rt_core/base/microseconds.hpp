// Durations of the loop and its workers as documents show them.
#pragma once

#include "rt_core/base/time.hpp"

namespace cellmirror {

constexpr double microseconds(Nanoseconds d) { return 1e-3 * static_cast<double>(d.count()); }

}  // namespace cellmirror
