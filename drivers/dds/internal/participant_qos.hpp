// Settings of a participant: transport, discovery, security.
#pragma once

#include <string>

#include "rt_core/base/result.hpp"
#include "rt_core/ports/dds_network.hpp"
#include "rt_core/ports/stream_config.hpp"

namespace eprosima::fastdds::dds {
class DomainParticipantQos;
}  // namespace eprosima::fastdds::dds

namespace cellmirror::dds {

[[nodiscard]] Result<void> check_domain(int domain);
// Fails where it is no IPv4 address of this machine.
[[nodiscard]] Result<void> check_address(const std::string& address);

// UDP on the interface with that address. `security`: absolute paths.
[[nodiscard]] eprosima::fastdds::dds::DomainParticipantQos participant_qos(int domain, const std::string& address,
                                                                           const DdsSecurityConfig& security,
                                                                           const DdsNetworkConfig& network);

}  // namespace cellmirror::dds
