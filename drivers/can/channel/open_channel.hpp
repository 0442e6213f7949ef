// The one way to a CAN channel: the endpoint's text decides which.
#pragma once

#include <cstdint>
#include <memory>

#include "rt_core/base/diagnostics.hpp"
#include "rt_core/base/result.hpp"
#include "rt_core/ports/can_channel.hpp"
#include "rt_core/ports/stream_config.hpp"

namespace cellmirror::can {

// "socketcan:can0", "udp:GROUP:PORT" (IPv6 groups in brackets) or "log:FILE". Fails where
// waiting does not help: a text that is not an endpoint, an interface that is not a CAN interface, a file that does not
// exist or is not a candump log, no permission. An interface that is down is not a failure. With WhereMissing::wait,
// nor is an interface that is missing or has no address yet: status() names it, and it is tried again until it exists.
// Not for the tick.
enum class WhereMissing : std::uint8_t { fail, wait };
[[nodiscard]] Result<std::unique_ptr<CanChannel>> open_can_channel(const CanChannelConfig& config,
                                                                   WhereMissing missing = WhereMissing::fail);

// Reports errors that can be found without opening the channel: a log: file of another format.
void check_channel(const CanChannelConfig& config, const Place& place, Diagnostics& diagnostics);

}  // namespace cellmirror::can
