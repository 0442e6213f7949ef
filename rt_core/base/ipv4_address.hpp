// IPv4 addresses as people write them.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace cellmirror {

struct Ipv4Address {
  std::string address;     // numeric
  std::uint16_t port = 0;  // 0: none was given

  bool operator==(const Ipv4Address&) const = default;
};

// "192.168.7.5" or "192.168.7.5:11811"; none for anything else, host names too.
[[nodiscard]] std::optional<Ipv4Address> parse_ipv4_address(std::string_view text);

}  // namespace cellmirror
