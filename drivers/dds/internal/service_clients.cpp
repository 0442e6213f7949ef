#include "drivers/dds/internal/service_clients.hpp"

#include <fastdds/rtps/reader/ReaderDiscoveryInfo.h>
#include <fastdds/rtps/writer/WriterDiscoveryInfo.h>

#include <optional>

#include "drivers/dds/internal/library_guid.hpp"
#include "rt_core/base/log.hpp"

namespace cellmirror::dds {

namespace {

namespace discovery = eprosima::fastrtps::rtps;

template <class Qos>
std::string_view user_data_of(const Qos& qos) {
  const auto& octets = qos.m_userData.getValue();
  return {reinterpret_cast<const char*>(octets.data()), octets.size()};
}

}  // namespace

void ServiceClients::on_publisher_discovery(eprosima::fastdds::dds::DomainParticipant* /*participant*/,
                                            discovery::WriterDiscoveryInfo&& info) {
  note(guid_of(info.info.guid()), user_data_of(info.info.m_qos),
       info.status == discovery::WriterDiscoveryInfo::REMOVED_WRITER);
}

void ServiceClients::on_subscriber_discovery(eprosima::fastdds::dds::DomainParticipant* /*participant*/,
                                             discovery::ReaderDiscoveryInfo&& info) {
  note(guid_of(info.info.guid()), user_data_of(info.info.m_qos),
       info.status == discovery::ReaderDiscoveryInfo::REMOVED_READER);
}

void ServiceClients::note(const Guid& endpoint, std::string_view user_data, bool gone) {
  bool noted = true;
  {
    const std::scoped_lock lock(mutex_);
    noted = endpoints_.note(endpoint, gone ? std::nullopt : client_id(user_data));
  }
  if (!noted && !warned_.exchange(true)) {
    log_warning("dds.action", "more than {} endpoints of clients (clientid=) are announced: others are not answered",
                ClientEndpoints::kMost);
  }
}

bool ServiceClients::contains(const Guid& endpoint) const {
  const std::scoped_lock lock(mutex_);
  return endpoints_.contains(endpoint);
}

bool ServiceClients::reaches(const RequestName& to, std::span<const Guid> readers) const {
  const std::scoped_lock lock(mutex_);
  return endpoints_.reaches(to, readers);
}

}  // namespace cellmirror::dds
