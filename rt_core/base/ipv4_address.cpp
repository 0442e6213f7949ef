#include "rt_core/base/ipv4_address.hpp"

#include <arpa/inet.h>

#include <algorithm>
#include <cstddef>

#include "rt_core/base/text.hpp"

namespace cellmirror {

std::optional<Ipv4Address> parse_ipv4_address(std::string_view text) {
  Ipv4Address out;
  const std::size_t colon = text.find(':');
  out.address = std::string(text.substr(0, colon));
  in_addr ignored{};
  // An embedded zero would end the text for inet_pton() alone.
  if (out.address.contains('\0') || inet_pton(AF_INET, out.address.c_str(), &ignored) != 1) return std::nullopt;
  if (colon == std::string_view::npos) return out;
  const std::string_view digits = text.substr(colon + 1);
  const auto port = parse_integer(digits);
  const bool plain = std::ranges::all_of(digits, [](char c) { return c >= '0' && c <= '9'; });
  if (!plain || !port || *port < 1 || *port > 65535) return std::nullopt;
  out.port = static_cast<std::uint16_t>(*port);
  return out;
}

}  // namespace cellmirror
