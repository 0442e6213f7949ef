// A CAN interface of Linux: CAN_RAW with FD frames and error frames.
#pragma once

#include <memory>
#include <string>

#include "rt_core/base/result.hpp"
#include "rt_core/ports/can_channel.hpp"

namespace cellmirror::can {

// Fails if the interface is not a CAN interface or permission is missing; unless `waits`, also if the kernel has no CAN
// or the interface does not exist. The channel survives an interface that is down, or deleted and created again, and a
// bus that goes bus-off; status() reports them.
[[nodiscard]] Result<std::unique_ptr<CanChannel>> open_socketcan_channel(const std::string& interface, bool waits);

}  // namespace cellmirror::can
