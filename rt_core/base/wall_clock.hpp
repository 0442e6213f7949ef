// UTC where a recording is played: its instants are of another machine, or of another start of this one.
#pragma once

#include <cstdint>

#include "rt_core/base/time.hpp"

namespace cellmirror {

// From now on to_wall_clock_ns() and from_wall_clock_ns() take UTC as the instant and this offset, in the whole
// process. Any thread.
void set_wall_clock_offset(Nanoseconds utc_minus_instant);
// As to_wall_clock_ns() without such an offset: for what belongs to this machine whatever is played. Not for the tick.
[[nodiscard]] std::int64_t machine_wall_clock_ns(Timestamp t);

}  // namespace cellmirror
