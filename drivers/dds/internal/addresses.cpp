#include "drivers/dds/internal/addresses.hpp"

#include <arpa/inet.h>
#include <fmt/core.h>
#include <ifaddrs.h>

#include <vector>

#include "rt_core/base/text.hpp"

namespace cellmirror::dds {

namespace {

constexpr int kMaxDomain = 232;  // RTPS 2.3, 9.6.1.1: beyond it the ports pass 65535

std::vector<std::string> ipv4_addresses() {
  std::vector<std::string> found;
  ifaddrs* list = nullptr;
  if (getifaddrs(&list) != 0) return found;
  for (const ifaddrs* entry = list; entry != nullptr; entry = entry->ifa_next) {
    if (entry->ifa_addr == nullptr || entry->ifa_addr->sa_family != AF_INET) continue;
    char text[INET_ADDRSTRLEN] = {};
    const auto* address = reinterpret_cast<const sockaddr_in*>(entry->ifa_addr);
    if (inet_ntop(AF_INET, &address->sin_addr, text, sizeof text) != nullptr) found.emplace_back(text);
  }
  freeifaddrs(list);
  return found;
}

}  // namespace

Result<void> check_domain(int domain) {
  if (domain >= 0 && domain <= kMaxDomain) return {};
  return fail(fmt::format("DDS domain {} does not exist", domain), fmt::format("use 0 to {}", kMaxDomain));
}

Result<void> check_address(const std::string& address) {
  std::string known;
  for (const std::string& own : ipv4_addresses()) {
    if (own == address) return {};
    known += (known.empty() ? "" : ", ") + own;
  }
  return fail(fmt::format("'{}' is not an IPv4 address of this machine", printable(address)),
              known.empty() ? "bring an interface up: ip link set lo up" : "use one of: " + known);
}

}  // namespace cellmirror::dds
