// Access checks: the header Origin (pages of other sites in the same browser), the header Host (DNS rebinding), and
// the token. Pure.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "ipc/web/http_request.hpp"

namespace cellmirror::web {

class AccessRules {
 public:
  // `address`: the numeric address on which the server listens; `origins`: further allowed origins, such as
  // "https://monitor.example.org" of a proxy.
  AccessRules(std::string_view address, int port, std::vector<std::string> origins);

  // Whether the header Host names this server. On loopback: 127.0.0.1, localhost, [::1]; elsewhere any numeric address;
  // in both cases the hosts of `origins`. A host name that an attacker resolves to this machine is not allowed.
  [[nodiscard]] bool host_allowed(std::string_view host) const;
  // Null (no such header) is allowed: programs other than browsers send none.
  [[nodiscard]] bool origin_allowed(const std::string* origin) const;

 private:
  [[nodiscard]] bool is_own_host(std::string_view host) const;

  bool loopback_;
  std::string port_;  // ":8420"
  std::vector<std::string> origins_;
};

// Whether only this machine can reach the address.
[[nodiscard]] bool is_loopback(std::string_view address);

// Takes a time that depends on the length of `given` alone. An empty token never matches.
[[nodiscard]] bool token_matches(std::string_view given, std::string_view token);
// Of "Authorization: Bearer TOKEN"; empty: there is none.
[[nodiscard]] std::string_view bearer_token(const HttpRequest& request);

// The bearer token. If the header Authorization has another scheme, the whole header after a mark that no token
// contains, so that it counts as a wrong token. Empty: no credentials.
[[nodiscard]] std::string shown_credentials(const HttpRequest& request);

// Scripts in browsers cannot add headers to the opening of a WebSocket, but they can name subprotocols: this one, and
// next to it "cellmirror.token." with the token. The server selects the first one.
inline constexpr std::string_view kSubprotocol = "cellmirror.live";
[[nodiscard]] bool offers_subprotocol(const HttpRequest& request);
// The bearer token, or that of the subprotocols; empty: there is none.
[[nodiscard]] std::string opening_token(const HttpRequest& request);

}  // namespace cellmirror::web
