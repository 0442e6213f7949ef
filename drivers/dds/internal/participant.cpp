#include "drivers/dds/internal/participant.hpp"

#include <fmt/core.h>

#include <utility>

#include "drivers/dds/type_hashes.hpp"
#include "rt_core/base/text.hpp"

namespace cellmirror::dds {

namespace {

constexpr std::size_t kMaxTopicLength = 255;

}  // namespace

Result<void> check_topic(std::string_view topic) {
  if (topic.empty() || topic.size() > kMaxTopicLength) {
    return fail(fmt::format("the DDS topic '{}' is empty or too long", printable(topic)),
                fmt::format("use 1 to {} characters; ROS 2's topic /x is rt/x here", kMaxTopicLength));
  }
  return {};
}

Result<std::shared_ptr<Participant>> Participant::shared(int domain, const std::string& interface_address,
                                                         const DdsSecurityConfig& security,
                                                         const std::string& partition) {
  auto link = DomainLink::shared(domain, interface_address, security);
  if (!link) return std::unexpected(link.error());
  return std::shared_ptr<Participant>(new Participant(std::move(*link), partition));
}

Result<std::uint32_t> Participant::add(const EndpointConfig& config, bool writer, EndpointEvents& events) {
  if (auto ok = check_topic(config.topic); !ok) return std::unexpected(ok.error());
  return link_->add({.id = 0,
                     .writer = writer,
                     .topic = config.topic,
                     .type = std::string(config.type),
                     .partition = partition_,
                     .user_data = type_user_data(config.type, link_->presence().messages()),
                     .reliable = config.reliable,
                     .depth = config.depth,
                     .large = config.large,
                     .transient_local = config.transient_local,
                     .counts_overwritten = config.counts_overwritten},
                    events);
}

Result<std::uint32_t> Participant::add_reader(const EndpointConfig& config, EndpointEvents& events) {
  return add(config, false, events);
}

Result<std::uint32_t> Participant::add_writer(const EndpointConfig& config, EndpointEvents& events) {
  return add(config, true, events);
}

}  // namespace cellmirror::dds
