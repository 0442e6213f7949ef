// The one way to a CAN channel: the endpoint's text decides which.
#pragma once

#include <memory>

#include "rt_core/base/result.hpp"
#include "rt_core/ports/can_channel.hpp"
#include "rt_core/ports/stream_config.hpp"

namespace cellmirror::can {

// "socketcan:can0", "udp:GROUP:PORT" (IPv6 groups in brackets) or "log:FILE". Fails for what cannot recover: a text
// that is no endpoint, a kernel without CAN, an interface or file that does not exist, no permission. An interface that
// is down is no failure. Not for the tick.
[[nodiscard]] Result<std::unique_ptr<CanChannel>> open_can_channel(const CanChannelConfig& config);

}  // namespace cellmirror::can
