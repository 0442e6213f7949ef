#include "drivers/dds/internal/service_clients.hpp"

#include <fastdds/rtps/writer/WriterDiscoveryInfo.h>

#include <string_view>

#include "drivers/dds/internal/library_guid.hpp"
#include "rt_core/base/log.hpp"

namespace cellmirror::dds {

void ServiceClients::on_publisher_discovery(eprosima::fastdds::dds::DomainParticipant* /*participant*/,
                                            eprosima::fastrtps::rtps::WriterDiscoveryInfo&& info) {
  const Guid writer = guid_of(info.info.guid());
  const auto& octets = info.info.m_qos.m_userData.getValue();
  const std::string_view user_data(reinterpret_cast<const char*>(octets.data()), octets.size());
  const bool gone = info.status == eprosima::fastrtps::rtps::WriterDiscoveryInfo::REMOVED_WRITER;
  bool noted = true;
  {
    const std::scoped_lock lock(mutex_);
    noted = writers_.note(writer, !gone && dds::announces_client(user_data));
  }
  if (!noted && !warned_.exchange(true)) {
    log_warning("dds.action",
                "more than {} writers of clients (clientid=) are announced: requests of others are refused",
                ClientWriters::kMost);
  }
}

bool ServiceClients::announces_client(const Guid& writer) const {
  const std::scoped_lock lock(mutex_);
  return writers_.contains(writer);
}

}  // namespace cellmirror::dds
