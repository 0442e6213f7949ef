// Settings of a participant: transport, discovery, security.
#pragma once

#include "drivers/dds/message/dds_message.hpp"

namespace eprosima::fastdds::dds {
class DomainParticipantQos;
}  // namespace eprosima::fastdds::dds

namespace cellmirror::dds {

// UDP on the interface with that address.
[[nodiscard]] eprosima::fastdds::dds::DomainParticipantQos participant_qos(const OpenParticipant& wanted);

}  // namespace cellmirror::dds
