// One partition of a DomainLink, for its readers and writers.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "drivers/dds/internal/addresses.hpp"
#include "drivers/dds/internal/domain_link.hpp"
#include "drivers/dds/internal/endpoint_config.hpp"
#include "rt_core/base/result.hpp"
#include "rt_core/ports/stream_config.hpp"

namespace cellmirror::dds {

// Keeps the link alive. Any thread.
class Participant {
 public:
  // `interface_address`: an IPv4 address of this machine; nothing leaves by other interfaces. `security`: absolute
  // paths; where it is enabled, peers that do not prove their identity are not seen. `partition`: its endpoints meet
  // only those in the same one; empty: those in none, as all of ROS 2.
  [[nodiscard]] static Result<std::shared_ptr<Participant>> shared(int domain, const std::string& interface_address,
                                                                   const DdsSecurityConfig& security,
                                                                   const std::string& partition = {});

  // See DomainLink::add().
  [[nodiscard]] Result<std::uint32_t> add_reader(const EndpointConfig& config, EndpointEvents& events);
  [[nodiscard]] Result<std::uint32_t> add_writer(const EndpointConfig& config, EndpointEvents& events);
  [[nodiscard]] DomainLink& link() { return *link_; }
  [[nodiscard]] const ServiceClients& clients() const { return link_->clients(); }

 private:
  Participant(std::shared_ptr<DomainLink> link, std::string partition)
      : link_(std::move(link)), partition_(std::move(partition)) {}
  [[nodiscard]] Result<std::uint32_t> add(const EndpointConfig& config, bool writer, EndpointEvents& events);

  std::shared_ptr<DomainLink> link_;
  std::string partition_;
};

}  // namespace cellmirror::dds
