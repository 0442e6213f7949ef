#include "drivers/dds/internal/service_clients.hpp"

#include <optional>

#include "rt_core/base/log.hpp"

namespace cellmirror::dds {

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

void ServiceClients::forget_all() {
  const std::scoped_lock lock(mutex_);
  endpoints_ = {};
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
