#include "drivers/dds/internal/endpoint_qos.hpp"

#include <string>

#include "drivers/dds/type_hashes.hpp"

namespace cellmirror::dds {

namespace {

namespace fd = eprosima::fastdds::dds;
namespace rtps = eprosima::fastrtps::rtps;

template <class Qos>
void set_common(Qos& qos, const EndpointConfig& config, RosDistribution distribution) {
  const std::string hash = type_user_data(config.type, distribution);
  qos.user_data().setValue({hash.begin(), hash.end()});
  qos.reliability().kind = config.reliable ? fd::RELIABLE_RELIABILITY_QOS : fd::BEST_EFFORT_RELIABILITY_QOS;
  qos.durability().kind = config.transient_local ? fd::TRANSIENT_LOCAL_DURABILITY_QOS : fd::VOLATILE_DURABILITY_QOS;
  qos.history().kind = fd::KEEP_LAST_HISTORY_QOS;
  qos.history().depth = config.depth;
  qos.endpoint().history_memory_policy = rtps::PREALLOCATED_WITH_REALLOC_MEMORY_MODE;
  qos.data_sharing().off();
}

}  // namespace

fd::DataReaderQos reader_qos(const EndpointConfig& config, RosDistribution distribution) {
  fd::DataReaderQos qos;
  set_common(qos, config, distribution);
  return qos;
}

fd::DataWriterQos writer_qos(const EndpointConfig& config, RosDistribution distribution, DdsLink link) {
  fd::DataWriterQos qos;
  set_common(qos, config, distribution);
  // Datagrams are small on a lossy link: what does not fit one is sent by a thread of the library's.
  const bool by_thread = config.large || link == DdsLink::lossy;
  qos.publish_mode().kind = by_thread ? fd::ASYNCHRONOUS_PUBLISH_MODE : fd::SYNCHRONOUS_PUBLISH_MODE;
  qos.reliability().max_blocking_time = {0, 1'000'000};                // how long write() may wait for a lock: 1 ms
  qos.reliable_writer_qos().times.heartbeatPeriod = {0, 100'000'000};  // so that a lost last sample is noticed soon
  return qos;
}

}  // namespace cellmirror::dds
