// A CAN interface of Linux: CAN_RAW with FD frames and error frames.
#pragma once

#include <memory>
#include <string>

#include "rt_core/base/result.hpp"
#include "rt_core/ports/can_channel.hpp"

namespace cellmirror::can {

// Fails where the interface is no CAN interface, or permission lacks, and unless it `waits` where the kernel has no CAN
// or the interface is not there. An interface that is down, is deleted and comes back, a bus that goes bus-off:
// survived and told by status().
[[nodiscard]] Result<std::unique_ptr<CanChannel>> open_socketcan_channel(const std::string& interface, bool waits);

}  // namespace cellmirror::can
