// A CAN bus over IP multicast in python-can's udp_multicast format.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "drivers/can/channel/endpoint.hpp"
#include "rt_core/base/result.hpp"
#include "rt_core/ports/can_channel.hpp"

namespace cellmirror::can {

// `interface`: the network interface that joins the group and sends; no frame crosses another one. Hop limit 1. What
// this channel sends does not come back to it, but reaches every other member of the group on this machine. Datagrams
// that are no frames are counted as malformed. `allow_from`: numeric addresses; datagrams of other senders are refused
// and counted as foreign; empty: all are accepted. Fails for a text that is not an address; unless `waits`, also if the
// interface does not exist or cannot join.
[[nodiscard]] Result<std::unique_ptr<CanChannel>> open_udp_channel(const UdpEndpoint& endpoint,
                                                                   const std::string& interface,
                                                                   const std::vector<std::string>& allow_from,
                                                                   bool waits);

}  // namespace cellmirror::can
