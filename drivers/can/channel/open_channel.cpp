#include "drivers/can/channel/open_channel.hpp"

#include <filesystem>

#include "drivers/can/channel/endpoint.hpp"
#include "drivers/can/channel/log_channel.hpp"
#include "drivers/can/channel/log_format.hpp"
#include "drivers/can/channel/socketcan_channel.hpp"
#include "drivers/can/channel/udp_channel.hpp"

namespace cellmirror::can {

Result<std::unique_ptr<CanChannel>> open_can_channel(const CanChannelConfig& config, WhereMissing missing) {
  const bool waits = missing == WhereMissing::wait;
  const auto endpoint = parse_endpoint(config.endpoint);
  if (!endpoint) return std::unexpected(endpoint.error());
  if (const auto* socketcan = std::get_if<SocketCanEndpoint>(&*endpoint)) {
    return open_socketcan_channel(socketcan->interface, waits);
  }
  if (const auto* udp = std::get_if<UdpEndpoint>(&*endpoint)) {
    return open_udp_channel(*udp, config.interface, config.allow_from, waits);
  }
  LogChannelOptions options;
  options.file = std::get<LogEndpoint>(*endpoint).file;
  options.as_fast_as_possible = config.log_as_fast_as_possible;
  options.repeat = config.log_repeat;
  return open_log_channel(options);
}

void check_channel(const CanChannelConfig& config, const Place& place, Diagnostics& diagnostics) {
  const auto endpoint = parse_endpoint(config.endpoint);
  const auto* log = endpoint ? std::get_if<LogEndpoint>(&*endpoint) : nullptr;
  // The reader of the cell file has already reported an invalid endpoint and a missing file.
  if (log == nullptr || !std::filesystem::is_regular_file(log->file)) return;
  if (const auto known = check_log(log->file); !known)
    diagnostics.error(place, known.error().what, known.error().remedy);
}

}  // namespace cellmirror::can
