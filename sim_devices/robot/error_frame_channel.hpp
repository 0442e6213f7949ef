// A SocketCAN channel that can send error frames too. The gateway's own channel never does; a simulated controller that
// leaves the bus has to, and a virtual CAN interface passes them on to its listeners.
#pragma once

#include <memory>
#include <string>

#include "rt_core/base/result.hpp"
#include "rt_core/ports/can_channel.hpp"

namespace cellmirror::sim {

// `channel` is open on `interface`. Frames other than error frames go through it unchanged.
[[nodiscard]] Result<std::unique_ptr<CanChannel>> with_error_frames(std::unique_ptr<CanChannel> channel,
                                                                    const std::string& interface);

}  // namespace cellmirror::sim
