#include "ipc/web/access.hpp"

#include <arpa/inet.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <utility>

#include "rt_core/base/text.hpp"

namespace cellmirror::web {

namespace {

bool is_numeric(int family, std::string_view address) {
  std::array<std::uint8_t, sizeof(in6_addr)> out{};
  return inet_pton(family, std::string(address).c_str(), out.data()) == 1;
}

// "127.0.0.1" or "[::1]", as in a Host header without its port.
bool is_numeric_host(std::string_view host) {
  if (host.starts_with('[') && host.ends_with(']')) return is_numeric(AF_INET6, host.substr(1, host.size() - 2));
  return is_numeric(AF_INET, host);
}

std::string_view host_of(std::string_view origin) {
  const std::size_t at = origin.find("://");
  return at == std::string_view::npos ? std::string_view() : origin.substr(at + 3);
}

}  // namespace

bool is_loopback(std::string_view address) {
  if (address == "::1") return true;
  return address.starts_with("127.") && is_numeric(AF_INET, address);
}

AccessRules::AccessRules(std::string_view address, int port, std::vector<std::string> origins)
    : loopback_(is_loopback(address)), port_(":" + std::to_string(port)), origins_(std::move(origins)) {}

bool AccessRules::host_allowed(std::string_view host) const {
  // The origin file:// has no host.
  const auto named = [&](const std::string& origin) {
    return !host.empty() && equal_ignoring_case(host_of(origin), host);
  };
  return std::ranges::any_of(origins_, named) || is_own_host(host);
}

bool AccessRules::is_own_host(std::string_view host) const {
  // Clients omit port 80.
  if (host.ends_with(port_)) {
    host.remove_suffix(port_.size());
  } else if (port_ != ":80") {
    return false;
  }
  if (equal_ignoring_case(host, "localhost") || host == "[::1]") return true;
  const bool numeric = is_numeric_host(host);
  return numeric && (!loopback_ || is_loopback(host));
}

bool AccessRules::origin_allowed(const std::string* origin) const {
  if (origin == nullptr) return true;
  const auto same = [&](const std::string& allowed) { return equal_ignoring_case(allowed, *origin); };
  if (std::ranges::any_of(origins_, same)) return true;
  constexpr std::string_view kScheme = "http://";
  return origin->starts_with(kScheme) && is_own_host(std::string_view(*origin).substr(kScheme.size()));
}

bool token_matches(std::string_view given, std::string_view token) {
  if (token.empty()) return false;
  // Volatile, so that the compiler cannot leave the loop early.
  volatile unsigned difference = given.size() == token.size() ? 0U : 1U;
  for (std::size_t i = 0; i < given.size(); ++i) {
    const auto a = static_cast<unsigned char>(given[i]);
    const auto b = static_cast<unsigned char>(token[i % token.size()]);
    difference = difference | static_cast<unsigned>(a ^ b);
  }
  return difference == 0;
}

std::string_view bearer_token(const HttpRequest& request) {
  constexpr std::string_view kScheme = "Bearer ";
  const std::string* value = request.header("authorization");
  if (value == nullptr || value->size() < kScheme.size()) return {};
  const std::string_view text = *value;
  return equal_ignoring_case(text.substr(0, kScheme.size()), kScheme) ? trimmed(text.substr(kScheme.size()))
                                                                      : std::string_view();
}

std::string shown_credentials(const HttpRequest& request) {
  if (const std::string_view bearer = bearer_token(request); !bearer.empty()) return std::string(bearer);
  const std::string* value = request.header("authorization");
  return value == nullptr || trimmed(*value).empty() ? std::string() : "\n" + *value;
}

bool offers_subprotocol(const HttpRequest& request) {
  return request.header_has("sec-websocket-protocol", kSubprotocol);
}

std::string opening_token(const HttpRequest& request) {
  constexpr std::string_view kMark = "cellmirror.token.";
  if (std::string shown = shown_credentials(request); !shown.empty()) return shown;
  const std::string* offered = request.header("sec-websocket-protocol");
  const std::size_t at = offered == nullptr ? std::string::npos : offered->find(kMark);
  if (at == std::string::npos) return {};
  const std::size_t begin = at + kMark.size();
  return offered->substr(begin, offered->find_first_of(", ", begin) - begin);
}

}  // namespace cellmirror::web
