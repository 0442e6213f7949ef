// Readers and writers of other participants that belong to clients of services (service_mapping.hpp).
#pragma once

#include <atomic>
#include <mutex>
#include <span>
#include <string_view>

#include "drivers/dds/service_mapping.hpp"

namespace cellmirror::dds {

// Any thread. The link notes an endpoint here before it reports the endpoint as matched.
class ServiceClients {
 public:
  // `gone`: the endpoint is no longer there.
  void note(const Guid& endpoint, std::string_view user_data, bool gone);
  void forget_all();
  // See ClientEndpoints.
  [[nodiscard]] bool contains(const Guid& endpoint) const;
  [[nodiscard]] bool reaches(const RequestName& to, std::span<const Guid> readers) const;

 private:
  mutable std::mutex mutex_;
  ClientEndpoints endpoints_;
  std::atomic<bool> warned_{false};
};

}  // namespace cellmirror::dds
