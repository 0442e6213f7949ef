// The one way to a CAN channel: the endpoint's text decides which.
#pragma once

#include <cstdint>
#include <memory>

#include "rt_core/base/diagnostics.hpp"
#include "rt_core/base/result.hpp"
#include "rt_core/ports/can_channel.hpp"
#include "rt_core/ports/stream_config.hpp"

namespace cellmirror::can {

// "socketcan:can0", "udp:GROUP:PORT" (IPv6 groups in brackets) or "log:FILE". Fails for what cannot recover: a text
// that is no endpoint, an interface that is no CAN interface, a file that does not exist or is no candump log, no
// permission. An interface that is down is no failure; one that is not there (or has no address yet) is none with
// WhereMissing::wait: then status() names it, and it is tried again until it is there. Not for the tick.
enum class WhereMissing : std::uint8_t { fail, wait };
[[nodiscard]] Result<std::unique_ptr<CanChannel>> open_can_channel(const CanChannelConfig& config,
                                                                   WhereMissing missing = WhereMissing::fail);

// Reports what would keep the channel from being opened and is known without opening it: a log: file of another format.
void check_channel(const CanChannelConfig& config, const Place& place, Diagnostics& diagnostics);

}  // namespace cellmirror::can
