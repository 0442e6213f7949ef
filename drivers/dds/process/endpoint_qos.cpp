#include "drivers/dds/process/endpoint_qos.hpp"

namespace cellmirror::dds {

namespace {

namespace fd = eprosima::fastdds::dds;
namespace rtps = eprosima::fastrtps::rtps;

template <class Qos>
void set_common(Qos& qos, const AddEndpoint& endpoint) {
  qos.user_data().setValue({endpoint.user_data.begin(), endpoint.user_data.end()});
  qos.reliability().kind = endpoint.reliable ? fd::RELIABLE_RELIABILITY_QOS : fd::BEST_EFFORT_RELIABILITY_QOS;
  qos.durability().kind = endpoint.transient_local ? fd::TRANSIENT_LOCAL_DURABILITY_QOS : fd::VOLATILE_DURABILITY_QOS;
  qos.history().kind = fd::KEEP_LAST_HISTORY_QOS;
  qos.history().depth = endpoint.depth;
  qos.endpoint().history_memory_policy = rtps::PREALLOCATED_WITH_REALLOC_MEMORY_MODE;
  qos.data_sharing().off();
}

}  // namespace

fd::DataReaderQos reader_qos(const AddEndpoint& endpoint) {
  fd::DataReaderQos qos;
  set_common(qos, endpoint);
  return qos;
}

fd::DataWriterQos writer_qos(const AddEndpoint& endpoint, DdsLink link) {
  fd::DataWriterQos qos;
  set_common(qos, endpoint);
  // Datagrams are small on a lossy link: a sample that does not fit one is sent by a thread of the library.
  const bool by_thread = endpoint.large || link == DdsLink::lossy;
  qos.publish_mode().kind = by_thread ? fd::ASYNCHRONOUS_PUBLISH_MODE : fd::SYNCHRONOUS_PUBLISH_MODE;
  qos.reliability().max_blocking_time = {0, 1'000'000};                // how long write() may wait for a lock: 1 ms
  qos.reliable_writer_qos().times.heartbeatPeriod = {0, 100'000'000};  // so that a lost last sample is noticed soon
  return qos;
}

}  // namespace cellmirror::dds
