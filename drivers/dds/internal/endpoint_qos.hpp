// Quality of service of readers and writers. Includes the library's headers.
#pragma once

#include <fastdds/dds/publisher/qos/DataWriterQos.hpp>
#include <fastdds/dds/subscriber/qos/DataReaderQos.hpp>

#include "drivers/dds/internal/endpoint_config.hpp"
#include "rt_core/ports/dds_network.hpp"
#include "rt_core/ports/ros_presence.hpp"

namespace cellmirror::dds {

[[nodiscard]] eprosima::fastdds::dds::DataReaderQos reader_qos(const EndpointConfig& config,
                                                               RosDistribution distribution);
[[nodiscard]] eprosima::fastdds::dds::DataWriterQos writer_qos(const EndpointConfig& config,
                                                               RosDistribution distribution, DdsLink link);

}  // namespace cellmirror::dds
