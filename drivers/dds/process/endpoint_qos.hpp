// Quality of service of readers and writers.
#pragma once

#include <fastdds/dds/publisher/qos/DataWriterQos.hpp>
#include <fastdds/dds/subscriber/qos/DataReaderQos.hpp>

#include "drivers/dds/message/dds_message.hpp"
#include "rt_core/ports/dds_network.hpp"

namespace cellmirror::dds {

[[nodiscard]] eprosima::fastdds::dds::DataReaderQos reader_qos(const AddEndpoint& endpoint);
[[nodiscard]] eprosima::fastdds::dds::DataWriterQos writer_qos(const AddEndpoint& endpoint, DdsLink link);

}  // namespace cellmirror::dds
