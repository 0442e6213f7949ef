// Whether the loop is on time, for those who watch the gateway from outside (/healthz).
#pragma once

#include "app/snapshot/fault_status.hpp"
#include "ipc/web/web_backend.hpp"
#include "rt_core/base/time.hpp"

namespace cellmirror::app {

// `age` of the newest tick, and from which age on the loop stands still; `faults` that are latched have happened a
// short time ago. Any thread.
[[nodiscard]] web::Health loop_health(Nanoseconds age, Nanoseconds stands_still_after, const FaultStatus& faults);

}  // namespace cellmirror::app
